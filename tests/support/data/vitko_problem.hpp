// The real recordings, imported once per test program.
#pragma once

#include <memory>
#include <vector>

#include "datasets/import/vitko2024/vitko2024.hpp"
#include "problems/calibration/calibration_problem.hpp"
#include "tests/support/shared_data.hpp"

namespace odobench::testing {

inline const Dataset& vitko_dataset() {
  static const Dataset set = import_vitko2024(shared_folder() / "datasets" / "vitko2024");
  return set;
}

inline std::vector<ParameterInfo> parameters_of(const Dataset& set) {
  return set.robot.parameters;
}

inline std::shared_ptr<const CalibrationProblem> vitko_model() {
  static const auto model =
      std::make_shared<const CalibrationProblem>(parameters_of(vitko_dataset()), vitko_dataset().recordings);
  return model;
}

// J* of spec and reference, and the acceptance limit J* (1 + 1e-6).
inline constexpr double kVitkoOptimum = 98.11878293011678;
inline constexpr double kVitkoLimit = 98.11878293 * (1 + 1e-6);

}  // namespace odobench::testing
