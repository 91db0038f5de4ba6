#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/table_parts.hpp"

namespace odobench {
namespace {

constexpr int kCostDigits = 10;   // enough to see which solvers end in the same point
constexpr int kSpreadDigits = 8;  // of random runs

Column column(std::string id, std::string name, std::string unit, std::string group,
              Align align = Align::Right, std::string latex = "") {
  return {std::move(id), std::move(name), std::move(unit), std::move(latex), std::move(group), align};
}

Cell cost_cell(const std::optional<double>& cost) {
  return cost ? significant_cell(*cost, kCostDigits) : Cell{};
}

Cell ratio_to_nominal(const Comparison& comparison, const RunRecord& record) {
  const ComparisonRow* nominal = comparison.nominal();
  if (nominal == nullptr || !nominal->shown->cost || !record.cost || *nominal->shown->cost <= 0) return {};
  return significant_cell(*record.cost / *nominal->shown->cost, 6);
}

// Relative, so that it does not depend on the scale of J; without meaning when the best J is zero.
Cell gap_to_best(const std::optional<double>& best, const RunRecord& record) {
  if (!best || !record.cost || *best <= 0) return {};
  return significant_cell((*record.cost - *best) / *best, 3);
}

std::vector<Column> cost_columns() {
  return {column("parameters", "parameters", "", "", Align::Left),
          best_if(Better::Lower, column("cost", "J", "", "cost", Align::Right, "$J$")),
          column("cost_ratio", "J / J_nominal", "", "cost", Align::Right, "$J / J_{\\mathrm{nominal}}$"),
          best_if(Better::Lower, column("gap", "gap to best", "", "cost"))};
}

constexpr const char* kGapNote =
    "Gap to best: (J - J_best) / J_best with the lowest J of this table's records.";

std::vector<Cell> solver_row(const Comparison& comparison, const ComparisonRow& row,
                             const std::optional<double>& best, bool polished) {
  const RunRecord& record = *row.shown;
  std::vector<Cell> cells{text_cell(row.label), cost_cell(record.cost), ratio_to_nominal(comparison, record),
                          gap_to_best(best, record)};
  if (polished) cells.push_back(cost_cell(record.cost_before_polish));
  if (row.kind == "run") {
    cells.push_back(count_cell(static_cast<double>(record.evaluations)));
    cells.push_back(count_cell(static_cast<double>(record.iterations)));
    cells.push_back(fixed_cell(record.seconds, 3));
    cells.push_back(text_cell(record.termination));
  } else {
    cells.insert(cells.end(), 3, Cell{});
    cells.push_back(text_cell(row.kind == "skipped" ? "skipped" : "evaluated"));
  }
  cells.push_back(text_cell(record.message));
  cells.push_back(text_cell(active_bounds(record)));
  return cells;
}

// J counts as reached when it is within `relative` of the best. At an optimum of zero nothing could ever be:
// the floor is twelve digits below the largest finite J in sight, so that the scale of J still does not
// matter.
double cost_scale(const Comparison& comparison) {
  double scale = 0;
  const auto consider = [&](double cost) {
    if (std::isfinite(cost)) scale = std::max(scale, std::abs(cost));
  };
  if (const ComparisonRow* nominal = comparison.nominal(); nominal != nullptr && nominal->shown->cost) {
    consider(*nominal->shown->cost);
    return scale;
  }
  for (const ComparisonRow& row : comparison.rows)
    for (const RunRecord* run : row.runs) {
      if (run->cost) consider(*run->cost);
      for (const TracePoint& point : run->trace) consider(point.cost);
    }
  return scale;
}

double count_within(const ComparisonRow& row, double best, double scale, double relative) {
  return static_cast<double>(std::count_if(row.runs.begin(), row.runs.end(), [&](const RunRecord* run) {
    return run->cost && *run->cost - best <= relative * std::abs(best) + 1e-12 * scale;
  }));
}

void append_spread(std::vector<Cell>& cells, const std::vector<double>& values, Cell (*make)(double)) {
  if (values.empty()) {
    cells.insert(cells.end(), 4, Cell{});
    return;
  }
  const Spread s = spread(values);
  for (double value : {s.median, s.min, s.max, s.interquartile_range()}) cells.push_back(make(value));
}

void append_spread_columns(std::vector<Column>& columns, const std::string& id, const std::string& name,
                           const std::string& unit) {
  columns.push_back(best_if(Better::Lower, column(id + "_median", name + " median", unit, id)));
  columns.push_back(best_if(Better::Lower, column(id + "_min", "min", unit, id)));
  columns.push_back(best_if(Better::Lower, column(id + "_max", "max", unit, id)));
  columns.push_back(best_if(Better::Lower, column(id + "_iqr", "IQR", unit, id)));
}

std::vector<Cell> repeats_row(const ComparisonRow& row, const std::optional<double>& best, double scale) {
  std::vector<double> costs, evaluations, seconds;
  for (const RunRecord* run : row.runs) {
    if (run->cost) costs.push_back(*run->cost);
    evaluations.push_back(static_cast<double>(run->evaluations));
    seconds.push_back(run->seconds);
  }
  std::vector<Cell> cells{text_cell(row.label), count_cell(static_cast<double>(row.runs.size())),
                          count_cell(static_cast<double>(row.runs.size() - costs.size()))};
  for (double relative : {1e-6, 1e-2})
    cells.push_back(best ? count_cell(count_within(row, *best, scale, relative)) : Cell{});
  append_spread(cells, costs, [](double v) { return significant_cell(v, kSpreadDigits); });
  append_spread(cells, evaluations, [](double v) { return significant_cell(v, 9); });
  append_spread(cells, seconds, [](double v) { return fixed_cell(v, 3); });
  return cells;
}

}  // namespace

Table solver_table(const Comparison& comparison) {
  Table table;
  table.id = comparison.id_prefix + "solvers";
  table.title = fmt::format("Solvers{}", comparison.title_suffix);
  table.columns = cost_columns();
  table.columns.front().id = table.columns.front().name = "solver";
  const bool polished =
      std::any_of(comparison.rows.begin(), comparison.rows.end(),
                  [](const ComparisonRow& row) { return row.shown->cost_before_polish.has_value(); });
  if (polished) table.columns.push_back(column("cost_before_polish", "J unpolished", "", "cost"));
  table.columns.push_back(best_if(Better::Lower, column("evaluations", "evaluations", "", "effort")));
  table.columns.push_back(column("iterations", "iterations", "", "effort"));
  table.columns.push_back(best_if(Better::Lower, column("seconds", "time", "s", "effort")));
  table.columns.push_back(column("termination", "stop", "", "stop", Align::Left));
  table.columns.push_back(column("message", "reason", "", "stop", Align::Left));
  table.columns.push_back(column("active_bounds", "active bounds", "", "stop", Align::Left));
  const std::optional<double> best = comparison.best_cost();
  for (const ComparisonRow& row : comparison.rows) {
    add_reference(table, row);
    table.rows.push_back(solver_row(comparison, row, best, polished));
  }
  table.notes.push_back(kGapNote);
  if (const std::string median = median_note(comparison); !median.empty()) table.notes.push_back(median);
  return table;
}

Table cost_table(const Comparison& comparison) {
  Table table;
  table.id = comparison.id_prefix + "cost";
  table.title = fmt::format("Cost{}", comparison.title_suffix);
  table.columns = cost_columns();
  table.columns.push_back(column("active_bounds", "active bounds", "", "", Align::Left));
  const std::optional<double> best = comparison.best_cost();
  for (const ComparisonRow& row : comparison.rows) {
    add_reference(table, row);
    table.rows.push_back({text_cell(row.label), cost_cell(row.shown->cost),
                          ratio_to_nominal(comparison, *row.shown), gap_to_best(best, *row.shown),
                          text_cell(active_bounds(*row.shown))});
  }
  if (comparison.rows.size() > 1) table.notes.push_back(kGapNote);
  return table;
}

std::optional<Table> repeats_table(const Comparison& comparison) {
  Table table;
  table.id = comparison.id_prefix + "repeats";
  table.title = fmt::format("Spread over repeated runs{}", comparison.title_suffix);
  table.columns = {column("solver", "solver", "", "", Align::Left), column("runs", "runs", "", "success"),
                   best_if(Better::Lower, column("failed", "failed", "", "success")),
                   best_if(Better::Higher, column("within_1e-6", "within 1e-6", "", "success")),
                   best_if(Better::Higher, column("within_1_percent", "within 1 %", "", "success"))};
  append_spread_columns(table.columns, "cost", "J", "");
  append_spread_columns(table.columns, "evaluations", "evaluations", "");
  append_spread_columns(table.columns, "seconds", "time", "s");
  const std::optional<double> best = comparison.best_cost();
  const double scale = cost_scale(comparison);
  for (const ComparisonRow& row : comparison.rows)
    if (row.kind == "run" && row.runs.size() > 1) table.rows.push_back(repeats_row(row, best, scale));
  if (table.rows.empty()) return std::nullopt;
  table.notes = {
      "Within 1e-6, 1 %: runs whose J exceeds the lowest J of these records by at most that fraction; "
      "failed: runs "
      "without a J, left out of its median, min, max and IQR.",
      "IQR: interquartile range, quartiles interpolated linearly between order statistics."};
  return table;
}

}  // namespace odobench
