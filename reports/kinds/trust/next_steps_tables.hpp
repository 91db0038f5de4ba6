// What a calibration leaves open, as sentences and tables: RunRecord::trust, its `explanations`, `twice_box`,
// `next` and intervals of single parameters.
//   explanations  what is left of J with a richer model each
//   next_drives   drives to make: what they decide or settle, how often, how long
#pragma once

#include <string>
#include <vector>

#include "reports/render/table.hpp"
#include "reports/statistics/row_groups.hpp"

namespace odobench {

// A clause of the verdict: "" where there is nothing to say, and the figures behind it.
struct OpenClause {
  std::string sentence;
  double value, against;
  std::string unit;
};
// value: half width of the best known single parameter, against: of the worst, % of the nominal value. Only
// where all parameters with a nominal value that is not 0 have intervals.
OpenClause single_parameters_clause(const RunRecord& record);
// value: by how much J falls in a box twice as wide, %; against: J there.
OpenClause twice_box_clause(const RunRecord& record);
// value: what the best richer model of the robot explains of J, %; against: the best competitor.
OpenClause explanation_clause(const RunRecord& record);
// value: how often the first drive is to be driven, against: of 100 such choices those that are right; or
// parameters that are settled and that are open.
OpenClause next_drives_clause(const RunRecord& record);

// Of the row with the lowest J that has any.
std::vector<Table> next_steps_tables(const Comparison& comparison);

}  // namespace odobench
