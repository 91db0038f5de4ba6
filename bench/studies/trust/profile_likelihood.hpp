// The profile of J along one parameter: J_p(v) = min J over the others in their boxes, with the parameter
// held at v.
//
// With a bound active or a curved valley it says more than a deviation at the optimum: whether J rises at all
// towards the ends of the box. An interval holds the values with J_p <= J* + rise, where for an estimate with
// variance s^2 (of the parameter, in q) and curvature H (of J/2) rise = t^2 s^2 / [H^-1]_jj.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "base/stop.hpp"
#include "bench/studies/watcher.hpp"
#include "problems/calibration/recording_costs.hpp"

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

// What --profile asks for.
struct ProfileChoice {
  std::vector<std::string> parameters;  // empty and not `all`: nothing
  bool all = false;
  int steps = 8;  // fits on each side of the result, before the ends are looked for

  bool wanted() const { return all || !parameters.empty(); }
};
// "all", or names separated by commas. Throws std::invalid_argument "--profile=TEXT: ..." for nothing and for
// a name that stands twice.
ProfileChoice profile_choice(const std::string& text, int steps);

// The profile along one parameter, with its 95 % interval: the values with J_p <= J* + rise (rise of
// problems/trust/combined_intervals.hpp). Ends are found to a thousandth of the rise between the outermost
// fits at or below it and their neighbours; +-infinity where J_p is below it at a bound.
struct ParameterProfile {
  std::string parameter;
  std::vector<ProfilePoint> points;  // ascending, the result among them
  double rise = std::numeric_limits<double>::quiet_NaN();
  ProfileEnds ends{rise, rise};  // not-a-number where there is no interval: `reason`
  std::string reason;
};

// Of the parameters asked for whose bounds differ, in the problem's order, at its minimum `z`. On each side
// `steps` fits at equal distances up to twice the half width that linearisation gives (to the bound where
// that is nearer or where it gives none), farther by half as far again each time while J_p does not reach the
// rise; every fit starts from its neighbour's, and from `z` as well where that does not converge. Sides are
// independent of each other: any number of threads gives the same bits. Throws std::invalid_argument for an
// unknown parameter and one whose bounds are alike, and Interruption.
std::vector<ParameterProfile> profiles(const std::shared_ptr<const CalibrationProblem>& problem,
                                       const RecordingCosts& recordings, const ProfileChoice& choice,
                                       const Vector& z, int threads, Watcher& watcher, const Stop& stop = {});

}  // namespace odobench
