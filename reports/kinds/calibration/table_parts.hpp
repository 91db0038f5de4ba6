// The single tables behind reports/kinds/calibration/calibration_tables.hpp. Each is empty when the
// comparison has nothing for it.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "reports/render/table.hpp"
#include "reports/statistics/row_groups.hpp"

namespace odobench {

// Thesis tables 36-41: one per trajectory, rows = labels; e_max, e_sr, sigma, 6 decimals.
std::vector<Table> error_tables(const Comparison& comparison);
// Thesis tables 2-7 in one: rows = trajectories, for a comparison of a single label.
std::optional<Table> error_overview(const Comparison& comparison);
// Lower bound, nominal, upper bound, then the labels; mm with 3 decimals where the unit is m, else 6
// significant digits. Empty without error tables: test functions have no parameters worth reading.
std::optional<Table> parameter_table(const Comparison& comparison);
// How many mean errors e_sr (trajectories times x, y, theta) of a row are above those of the nominal
// parameters.
struct WorseMeans {
  int worse = 0, all = 0;
};
WorseMeans worse_means(const ComparisonRow& row, const ComparisonRow& nominal);

// Thesis table 42. A label that lacks a trajectory has no sums.
std::optional<Table> totals_table(const Comparison& comparison);

// Whether a solver ran or a cost is known: else a table of solvers has nothing to say.
bool has_costs(const Comparison& comparison);
Table solver_table(const Comparison& comparison);
// Label and J only.
Table cost_table(const Comparison& comparison);
std::optional<Table> repeats_table(const Comparison& comparison);

// Its place among the rows, as Table::references wants it: the nominal parameters do not compete with
// results.
void add_reference(Table& table, const ComparisonRow& row);

// "upper a1 b2; lower a2", "" when every parameter is inside the box.
std::string active_bounds(const RunRecord& record);

// Nothing in place of an infinite number: what was computed from finite ones and overflowed has no value to
// show.
inline Cell unless_infinite(Cell cell) {
  return cell.value && std::isinf(*cell.value) ? Cell{} : cell;
}

}  // namespace odobench
