// What a calibration comes to on one screen: a row per method and the parameters of the best one.
#pragma once

#include <optional>
#include <string>

#include "reports/render/table.hpp"
#include "reports/statistics/row_groups.hpp"

namespace odobench {

// "overview": a row per label, nominal first, of the median run by J as in the other tables:
//   rms_position [mm], rms_heading [deg]  over all samples with a reference (fit_table.hpp)
//   total_change [%]    of the total error of the thesis (sums of e_sr), against nominal
//   held_out [%]        the same on repetitions that were left out, where that was worked out
//   gap                 (J - lowest J) / lowest J
//   runs, evaluations, seconds, bounds (parameters on a bound of their box), termination
// Columns without content are left out. Empty without errors per recording: the table of solvers says it all.
std::optional<Table> overview_table(const Comparison& comparison);
bool has_overview(const Comparison& comparison);

// "found": the parameters of the run with the lowest J in one sentence, mm where the unit is m, with 95 %
// intervals where there are any and "(bound)" behind those on a bound. Empty where overview_table() is, and
// without a result.
std::optional<Table> found_table(const Comparison& comparison);

// The run with the lowest finite J of a comparison, and its row; null without one.
struct BestRun {
  const ComparisonRow* row = nullptr;
  const RunRecord* record = nullptr;
};
BestRun best_run(const Comparison& comparison);

}  // namespace odobench
