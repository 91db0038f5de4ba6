// Tables of parameter sets judged on new drives (`bench verify`). Such a record has problem
// kVerificationProblem, kind "evaluation", the errors of every drive of every repeat, and
//   statistics  arrival_position.DRIVE [m], arrival_heading.DRIVE [rad]: mean distance of the true end from
//               the reference's
#pragma once

#include <optional>
#include <vector>

#include "reports/records/record.hpp"
#include "reports/render/table.hpp"

namespace odobench {

inline constexpr const char* kVerificationProblem = "verification";

// verify.arrival of records that say where the robot ended; none otherwise. Of one data set (scenario).
std::optional<Table> arrival_table(const std::vector<RunRecord>& records);
// That of each data set among them, named in the title where there are several.
std::vector<Table> arrival_tables(const std::vector<RunRecord>& records);

}  // namespace odobench
