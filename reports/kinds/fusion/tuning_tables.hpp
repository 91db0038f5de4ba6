// Tables of noise parameters fitted for a filter (`bench tune`). Such a record has the problem
// "tuning:OBJECTIVE", kind "evaluation", log10 of the standard deviations as parameters, the cost, the errors
// on the drives that judge, the verdict as message, why the solver stopped as termination ("evaluated": the
// given setting), and
//   measures    rmse_position [m], rmse_heading [rad], nees_mean
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "reports/records/record.hpp"
#include "reports/render/table.hpp"

namespace odobench {

inline constexpr const char* kTuningProblem = "tuning";  // what stands before the colon

// What the records of one tuning have in common and do not keep.
struct TuningCircumstances {
  std::vector<std::string> remarks;        // below the table of standard deviations
  std::size_t training = 0, held_out = 0;  // recordings; without held-out ones the same judge
};

// sigmas   a row per standard deviation, a column per setting
// tuning   a row per setting: cost, evaluations, errors and consistency on the drives that judge
// `records`: of one tuning, one per setting, the given one first.
std::vector<Table> tuning_tables(const std::vector<RunRecord>& records, const TuningCircumstances& tuning);

}  // namespace odobench
