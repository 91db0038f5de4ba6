// The profile of J along one parameter: J_p(v) = min J over the others in their boxes, with the parameter
// held at v.
//
// With a bound active or a curved valley it says more than a deviation at the optimum: whether J rises at all
// towards the ends of the box. An interval holds the values with J_p <= J* + rise, where for an estimate with
// variance s^2 (of the parameter, in q) and curvature H (of J/2) rise = t^2 s^2 / [H^-1]_jj.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "problems/calibration/calibration_problem.hpp"

namespace odobench {

struct ProfilePoint {
  double value = 0;  // of the parameter, in its unit
  double cost = 0;   // J_p
  Vector z;
};

// At each of `values`, in their order; every fit starts from `start` (all parameters) and from where the
// one before
// ended, and the better counts. Throws std::invalid_argument for an unknown parameter or a value outside
// the box.
std::vector<ProfilePoint> profile_likelihood(std::shared_ptr<const CalibrationProblem> problem,
                                             const std::string& parameter, const std::vector<double>& values,
                                             const Vector& start, const std::string& solver = "lm");

// Where J_p crosses `limit`, by straight lines between the points (ascending values): the first value at or
// below it and the last, +-infinity where the profile ends below.
struct ProfileEnds {
  double lower, upper;
};
ProfileEnds profile_ends(const std::vector<ProfilePoint>& points, double limit);

}  // namespace odobench
