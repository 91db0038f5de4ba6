// Whether intervals hold: sets of known truth are calibrated, and what the intervals say is compared with it.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "bench/catalogue/problem_factory.hpp"
#include "datasets/dataset.hpp"

namespace odobench::testing {

// Of one kind of interval: how many were given, how many held the truth; what was refused.
struct Held {
  int given = 0, held = 0, refused = 0;
  double share() const { return given > 0 ? 100.0 * held / given : 0; }
  Held& operator+=(const Held& other);
};

struct SetCoverage {
  // "new kinds" and "same drives" of every number that the drives determine, by its name; "parameters",
  // "end errors" of drives that the calibration has not seen.
  std::map<std::string, Held> determined, same_drives;
  Held parameters, end_errors;
  int on_bounds = 0;
  bool systematic = false;
  bool rule_said = false;  // that the rule of integration moves a number
};

// Calibrates `set` with lm, judges with its parameter set "truth" and with the drives of `fresh`, which the
// same robot made. `choice`: rule and model of the calibration, which has the parameters of the truth.
SetCoverage coverage_of(const Dataset& set, const Dataset& fresh, const CalibrationChoice& choice = {});

}  // namespace odobench::testing
