// How large the errors of a calibration are, by medians, which a few large ones do not move.
#pragma once

#include "problems/calibration/calibration_problem.hpp"

namespace odobench {

// Standard deviations of normal errors with these medians: of the distance in the plane / 1.17741 (its median
// for a deviation of 1 per axis), m, and 1.4826 times of the size of the heading error, rad. 0 where the cost
// has no headings. Errors are those of rows, without the weights of J.
struct ErrorScales {
  double position = 0, heading = 0;
};
ErrorScales error_scales(const CalibrationProblem& problem, const ConstVectorRef& z);

// Median over the recordings of sqrt(J_n / N_n), N_n rows of recording n, with the weights of J.
double recording_scale(const CalibrationProblem& problem, const ConstVectorRef& z);

// sqrt(J_n / N_n), 0 without rows, of every recording of a problem with the squared loss.
std::vector<double> recording_deviations(const CalibrationProblem& problem, const ConstVectorRef& z);

// The middle one, or the mean of the two in the middle. Of none 0.
double middle_of(std::vector<double> values);

// Four significant digits, as they are printed: who types them gets the same calibration.
double four_digits(double value);

}  // namespace odobench
