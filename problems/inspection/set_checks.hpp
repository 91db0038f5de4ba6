// What all recordings together say about units, geometry and frames.
#pragma once

#include <vector>

#include "problems/inspection/drive_set.hpp"
#include "problems/inspection/finding.hpp"

namespace odobench::inspection {

// Drives that do not begin at the origin, where the robot's calibration begins there.
std::vector<Finding> check_starts(const RobotView& robot, const DriveSet& drives);

// common_factor or time_unit, corrected in `drives`, and rotation_factor. Over the used samples
//     k_v = sum |F_xy| / sum |Wt_xy|        where |Wt_xy| > 3 rho |Wt_w|   (k_w where nothing is straight)
//     k_w = sum F_w Wt_w / sum Wt_w^2       where rho |Wt_w| > 0.8 |Wt_xy|
// |ln k_v| > ln 1.12 is a common factor, named where a usual one is within 15 %; |ln (k_w / k_v)| > ln 1.12
// one of rotations.
std::vector<Finding> check_factors(const RobotView& robot, DriveSet& drives);

// heading_turned or steering_zero, and tracked_point; corrected in `drives`.
//     beta   = angle of sum F_xy conj(Wt_xy), modulo pi, where it drives straight
//     zero_i = half the angle of sum |u_i|^2 exp 2j(angle of u_i - phi_i) there, median over the recordings
//     lever  = sum (F_xy - Wt_xy) w / (j sum w^2) where it turns
std::vector<Finding> check_frames(const RobotView& robot, DriveSet& drives);

// reference_lag by lag_of() of every recording of at least 40 samples without gaps, corrected in `drives`.
std::vector<Finding> check_lag(const RobotView& robot, DriveSet& drives);

// Misfit, slip and repeated speeds of single recordings, or that nothing fits. `rotation_is_off`: a factor of
// rotations was found, which makes recordings that turn unlike the others.
std::vector<Finding> check_recordings_alike(const RobotView& robot, DriveSet& drives, bool rotation_is_off);

// theta, x, y at t + lag by linear interpolation; the ends are held.
Vector shifted(const Vector& t, const Vector& v, double lag);

}  // namespace odobench::inspection
