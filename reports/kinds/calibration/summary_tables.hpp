// Many problems whose best cost is known (docs/problems.md), in one table: which solver solves how many, at
// what cost, and whether it told the truth about it.
#pragma once

#include <vector>

#include "reports/records/record.hpp"
#include "reports/render/table.hpp"

namespace odobench {

// Of the runs with RunRecord::known, in this order; nothing unless they are of two problems at least.
//   problems_unsolved  one row per run that did not solve its problem: J beside the lowest known, and how it
//                      ended
//   problems_summary   one row per family of problems ("nist" of "nist:Misra1a/1"; "classic" without a colon)
//                      and label: problems, runs, solved, runs that say `converged` at another point (rightly
//                      where that is a minimum of its own), false verdicts (false_verdict), digits of the
//                      parameters, evaluations, time
std::vector<Table> summary_tables(const std::vector<RunRecord>& records);

}  // namespace odobench
