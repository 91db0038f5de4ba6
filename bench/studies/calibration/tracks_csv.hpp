// Driven paths as CSV, for plots: where given parameters say the robot was, beside where it was.
#pragma once

#include <string>
#include <vector>

#include "bench/studies/parameter_sets.hpp"
#include "problems/calibration/calibration_problem.hpp"

namespace odobench {

// One row per recording, parameter set and sample, in this order: recording, parameters (the set's label),
// time_s [s], x, y [m], theta [rad] by odometry from the parameters, x_ref, y_ref, theta_ref by motion
// capture. Numbers are the shortest that read back as the same bits; lines end in \n; fields are quoted where
// RFC 4180 wants it.
std::string tracks_csv(const CalibrationProblem& problem, const std::vector<ParameterSet>& sets);

}  // namespace odobench
