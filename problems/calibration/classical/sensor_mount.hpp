// Where a sensor sits on a robot of any class, before anything is calibrated.
#pragma once

#include <optional>
#include <vector>

#include "datasets/recording.hpp"
#include "datasets/robots/robot.hpp"
#include "problems/calibration/classical/classical.hpp"

namespace odobench::classical {

// x, y [m], yaw [rad] of the tracked frame in the body frame: Censi's equations piece by piece (censi.cpp)
// with the motions of the robot's nominal parameters times one unknown factor in the place of those with a
// track of 1, so for any class and any yaw. Off by what the nominal parameters are off: a start for a fit.
// Nothing where the pieces do not tell it: no turns, all of the same curvature.
std::optional<Eigen::Vector3d> sensor_mount(const Robot& robot, const std::vector<Recording>& recordings,
                                            const Options& options = {});

}  // namespace odobench::classical
