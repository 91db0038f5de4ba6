// Parameter sets judged on new drives that are steered by them: the study behind `bench verify`.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/stop.hpp"
#include "bench/studies/parameter_sets.hpp"
#include "bench/studies/watcher.hpp"
#include "problems/instruction_set.hpp"
#include "reports/records/record.hpp"
#include "reports/statistics/statistics.hpp"

namespace odobench {

struct VerificationStudy {
  std::string scenario;                 // file or name
  std::vector<std::string> parameters;  // files or names, comma lists; "nominal" is always the first
  int repeat = 10;                      // times that all drives are driven
  std::uint64_t seed = 1;               // of the noise
  int threads = 0;                      // 0: one per core; results do not depend on them
  std::optional<InstructionSet> kernel;
};

// One repeat of all drives with one set.
struct VerifyOutcome {
  std::vector<RecordingError> recordings;
  std::vector<TrajectoryErrors> errors;
  Totals totals;
  // Mean distance of the true end from the reference's, m, and of the headings, rad, by trajectory.
  std::vector<std::array<double, 2>> arrival;
};

struct Verification {
  std::vector<std::string> drives;  // of the scenario
  std::vector<ParameterSet> sets;
  std::vector<std::vector<VerifyOutcome>> outcomes;  // by set and repeat
  // One per set: the errors of every drive of every repeat, and where the robot really ended.
  std::vector<RunRecord> records;
};

// Every repeat has noise of its own, the same for all sets. Throws std::invalid_argument on unknown names, an
// open-loop scenario and too much work, DataError on a bad file, Interruption when it is to stop.
Verification verify_parameters(const VerificationStudy& study, Watcher& watcher, const Stop& stop);

// Mean and half the width of its 95 % interval (Student); no interval of a single value.
struct Estimate {
  double mean = 0;
  std::optional<double> half_width;
};
Estimate estimate(const std::vector<double>& values);

using Pick = std::function<double(const VerifyOutcome&)>;
std::vector<double> picked(const std::vector<VerifyOutcome>& outcomes, const Pick& pick);

}  // namespace odobench
