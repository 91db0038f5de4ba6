// Tables of parameter sets judged on new drives (`bench verify`). Such a record has problem
// kVerificationProblem, kind "evaluation", the errors of every drive of every repeat, and
//   measures    arrival_position.DRIVE [m], arrival_heading.DRIVE [rad]: mean distance of the true end from
//               the reference's
#pragma once

#include <vector>

#include "reports/records/record.hpp"
#include "reports/render/table.hpp"

namespace odobench {

inline constexpr const char* kVerificationProblem = "verification";

inline constexpr const char* kArrivalPosition = "arrival_position.";
inline constexpr const char* kArrivalHeading = "arrival_heading.";

// verify.arrival of each data set (scenario) among the records of this problem that say where the robot
// ended; named in the title where there are several.
std::vector<Table> arrival_tables(const std::vector<RunRecord>& records);

}  // namespace odobench
