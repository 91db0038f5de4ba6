// The noise of the odometry as controllers, filters and localisers take it.
#pragma once

#include <string>

#include "bench/studies/exporting/controller_keys.hpp"

namespace odobench {

// What the numbers are for: a controller that publishes every 20 ms, amcl's updates every 0.25 m or 0.2 rad.
inline constexpr double kPublishPeriod = 0.02, kAmclDistance = 0.25, kAmclAngle = 0.2;

// pose_covariance_diagonal and twist_covariance_diagonal of a controller of ros2_controllers, and as
// statements where they come from, what robot_localization should use and amcl's alphas. A variance that came
// out as 0 is taken at its upper bound: no filter may believe something for certain. Nothing without noise
// figures. `keys`: whether the controller has the two keys; else the statements alone.
void add_noise_keys(const ParameterFile& file, bool keys, KeyTable& table);

// Every term by its name below "noise", with its interval.
void add_noise_terms(const ParameterFile& file, KeyTable& table);

}  // namespace odobench
