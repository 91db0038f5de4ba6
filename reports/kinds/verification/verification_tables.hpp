// Tables of parameter sets judged on new drives (`bench verify`). Such a record has problem
// kVerificationProblem, kind "evaluation", the errors of every drive of every repeat, and
//   measures    arrival_position.DRIVE [m], arrival_heading.DRIVE [rad]: mean distance of the true end from
//               the reference's
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "reports/records/record.hpp"
#include "reports/render/table.hpp"
#include "reports/statistics/statistics.hpp"

namespace odobench {

inline constexpr const char* kVerificationProblem = "verification";

inline constexpr const char* kArrivalPosition = "arrival_position.";
inline constexpr const char* kArrivalHeading = "arrival_heading.";

// One repeat of all drives with one set.
struct VerifyOutcome {
  std::vector<RecordingError> recordings;
  std::vector<TrajectoryErrors> errors;
  Totals totals;
  // Mean distance of the true end from the reference's, m, and of the headings, rad, by trajectory.
  std::vector<std::array<double, 2>> arrival;
};

// The repeats, of which a record keeps the errors and the means: differences and intervals need them apart.
struct VerificationRounds {
  std::vector<std::string> drives;                   // of the scenario
  std::vector<std::string> labels;                   // of the parameter sets; differences are to the first
  std::vector<std::vector<VerifyOutcome>> outcomes;  // by set and repeat, of both at least one
  std::vector<std::string> notes = {};               // for the totals, a sentence without a full stop each
};

// Mean and half the width of its 95 % interval (Student); no interval of a single value.
struct Estimate {
  double mean = 0;
  std::optional<double> half_width;
};
Estimate estimate(const std::vector<double>& values);

using Pick = std::function<double(const VerifyOutcome&)>;
std::vector<double> picked(const std::vector<VerifyOutcome>& outcomes, const Pick& pick);

// verify.DRIVE per drive, verify.totals, verify.arrival: means over the repeats with their intervals.
std::vector<Table> verification_tables(const VerificationRounds& rounds);

// verify.arrival of each data set (scenario) among the records of this problem that say where the robot
// ended; named in the title where there are several.
std::vector<Table> arrival_tables(const std::vector<RunRecord>& records);

}  // namespace odobench
