#include "reports/kinds/calibration/calibration_tables.hpp"

#include <utility>

#include "reports/kinds/calibration/drive_tables.hpp"
#include "reports/kinds/calibration/fit_table.hpp"
#include "reports/kinds/calibration/overview_tables.hpp"
#include "reports/kinds/calibration/summary_tables.hpp"
#include "reports/kinds/calibration/table_parts.hpp"
#include "reports/kinds/calibration/verdict_table.hpp"
#include "reports/kinds/trust/loss_tables.hpp"
#include "reports/kinds/trust/next_steps_tables.hpp"
#include "reports/kinds/trust/noise_tables.hpp"
#include "reports/kinds/trust/trust_tables.hpp"
#include "reports/kinds/trust/validation_tables.hpp"
#include "reports/statistics/row_groups.hpp"

namespace odobench {
namespace {

constexpr std::size_t kFewProblems = 4;  // whose solvers are all shown where a table sums them up

void append(std::vector<Table>& tables, std::optional<Table> table) {
  if (table) tables.push_back(std::move(*table));
}

void append_notes(Table& table, const std::vector<std::string>& notes) {
  table.notes.insert(table.notes.end(), notes.begin(), notes.end());
}

// Parameter table with the notes, else the notes go to `otherwise`.
void append_parameters(std::vector<Table>& tables, const Comparison& comparison, Table& otherwise,
                       const std::vector<std::string>& notes) {
  std::optional<Table> parameters = parameter_table(comparison);
  append_notes(parameters ? *parameters : otherwise, notes);
  append(tables, std::move(parameters));
}

}  // namespace

std::vector<Table> comparison_tables(const std::vector<RunRecord>& records,
                                     const std::vector<std::string>& notes) {
  std::vector<Table> tables, overall = summary_tables(records);
  const std::vector<Comparison> comparisons = compare(records);
  for (const Comparison& comparison : comparisons) {
    append(tables, verdict_table(comparison));
    append(tables, overview_table(comparison));
    std::optional<Table> found = found_table(comparison);
    if (found) append_notes(*found, notes);
    const bool noted = found.has_value();
    append(tables, std::move(found));
    for (Table& table : error_tables(comparison)) tables.push_back(std::move(table));
    for (Table& table : drive_tables(comparison)) tables.push_back(std::move(table));
    Table solvers = solver_table(comparison);
    solvers.key = !has_overview(comparison) && (overall.empty() || comparisons.size() <= kFewProblems);
    append_parameters(tables, comparison, solvers, noted ? std::vector<std::string>{} : notes);
    append(tables, totals_table(comparison));
    for (Table& table : validation_tables(comparison)) tables.push_back(std::move(table));
    append(tables, fit_table(comparison));
    for (Table& table : noise_tables(comparison)) tables.push_back(std::move(table));
    append(tables, weighted_down_table(comparison));
    append(tables, set_aside_table(comparison));
    for (Table& table : trust_tables(comparison)) tables.push_back(std::move(table));
    for (Table& table : next_steps_tables(comparison)) tables.push_back(std::move(table));
    if (has_costs(comparison)) tables.push_back(std::move(solvers));
    append(tables, repeats_table(comparison));
  }
  for (Table& table : overall) tables.push_back(std::move(table));
  return tables;
}

std::vector<Table> evaluation_tables(const std::vector<RunRecord>& records,
                                     const std::vector<std::string>& notes) {
  std::vector<Table> tables;
  for (const Comparison& comparison : compare(records)) {
    Table cost = cost_table(comparison);
    std::vector<Table> rest;
    if (comparison.rows.size() == 1)
      append(rest, error_overview(comparison));
    else
      rest = error_tables(comparison);
    for (Table& table : drive_tables(comparison)) rest.push_back(std::move(table));
    append_parameters(rest, comparison, cost, notes);
    append(rest, totals_table(comparison));
    append(rest, fit_table(comparison));
    cost.key = true;
    tables.push_back(std::move(cost));
    for (Table& table : rest) tables.push_back(std::move(table));
  }
  return tables;
}

}  // namespace odobench
