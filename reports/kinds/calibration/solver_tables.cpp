#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/kinds/calibration/table_parts.hpp"

namespace odobench {
namespace {

constexpr int kCostDigits = 10;   // enough to see which solvers end in the same point
constexpr int kSpreadDigits = 8;  // of random runs

Cell cost_cell(const std::optional<double>& cost) {
  return cost ? significant_cell(*cost, kCostDigits) : Cell{};
}

Cell with_noise(Cell cell, std::optional<double> noise) {
  cell.noise = noise;
  return cell;
}

std::optional<double> cost_noise(const ComparisonRow& row) {
  return noise_over_runs(row, [](const RunRecord& run) { return run.cost; });
}

// The lowest known J of the problem, where there is one.
std::optional<double> known_cost(const Comparison& comparison) {
  for (const ComparisonRow& row : comparison.rows)
    if (row.shown->known) return row.shown->known->cost;
  return std::nullopt;
}

Cell ratio_to_nominal(const Comparison& comparison, const RunRecord& record) {
  const ComparisonRow* nominal = comparison.nominal();
  if (nominal == nullptr || !nominal->shown->cost || !record.cost || *nominal->shown->cost <= 0) return {};
  return unless_infinite(significant_cell(*record.cost / *nominal->shown->cost, 6));
}

// The J that others are measured against: the lowest known, else the lowest of these records.
struct GapReference {
  std::optional<double> known, best;
  explicit GapReference(const Comparison& comparison)
      : known(known_cost(comparison)), best(comparison.best_cost()) {}

  const char* name() const { return known ? "gap to optimum" : "gap to best"; }
  std::string note() const {
    if (!known) return "Gap to best: (J - J_best) / J_best with the lowest J of this table's records.";
    return *known != 0
               ? fmt::format("Gap to optimum: (J - J*) / |J*| with the lowest known J* = {:.10g}.", *known)
               : std::string("Gap to optimum: J itself, since the lowest known J is 0.");
  }
  // Relative, so that it does not depend on the scale of J; without meaning when the best J of the records is
  // zero.
  Cell cell(const ComparisonRow& row) const {
    const std::optional<double>& cost = row.shown->cost;
    const double from = known.value_or(best.value_or(0));
    if (!cost || (!known && from <= 0)) return {};
    const double unit = from == 0 ? 1.0 : std::abs(from);
    const double noise = std::max(cost_noise(row).value_or(0), kRepeats * std::abs(*cost));
    return with_noise(unless_infinite(significant_cell((*cost - from) / unit, 3)), noise / unit);
  }
};

std::vector<Column> cost_columns(const GapReference& gap) {
  return {text_column("parameters"), best_if(Better::Lower, number_column("cost", "J", "", "cost", "$J$")),
          number_column("cost_ratio", "J / J_nominal", "", "cost", "$J / J_{\\mathrm{nominal}}$"),
          best_if(Better::Lower, number_column("gap", gap.name(), "", "cost"))};
}

std::vector<Cell> solver_row(const Comparison& comparison, const ComparisonRow& row, const GapReference& gap,
                             bool polished) {
  const RunRecord& record = *row.shown;
  std::vector<Cell> cells{text_cell(row.label), with_noise(cost_cell(record.cost), cost_noise(row)),
                          ratio_to_nominal(comparison, record), gap.cell(row)};
  if (polished) cells.push_back(cost_cell(record.cost_before_polish));
  if (row.kind == "run") {
    cells.push_back(with_noise(count_cell(static_cast<double>(record.evaluations)),
                               noise_over_runs(row, [](const RunRecord& run) {
                                 return std::optional<double>(static_cast<double>(run.evaluations));
                               })));
    cells.push_back(count_cell(static_cast<double>(record.iterations)));
    cells.push_back(with_noise(fixed_cell(record.seconds, 3), timing_noise(row)));
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
  for (double value : {s.median, s.min, s.max})
    cells.push_back(with_noise(make(value), s.interquartile_range()));
  cells.push_back(make(s.interquartile_range()));
}

void append_spread_columns(std::vector<Column>& columns, const std::string& id, const std::string& name,
                           const std::string& unit) {
  columns.push_back(best_if(Better::Lower, number_column(id + "_median", name + " median", unit, id)));
  columns.push_back(best_if(Better::Lower, number_column(id + "_min", "min", unit, id)));
  columns.push_back(best_if(Better::Lower, number_column(id + "_max", "max", unit, id)));
  columns.push_back(number_column(id + "_iqr", "IQR", unit, id));
}

// k of n runs; noise: the binomial standard deviation at (k + 1) / (n + 2), which is not zero for none or
// all.
Cell share_cell(double k, std::size_t runs) {
  const auto n = static_cast<double>(runs);
  const double p = (k + 1) / (n + 2);
  return with_noise(count_cell(k), std::sqrt(n * p * (1 - p)));
}

std::vector<Cell> repeats_row(const ComparisonRow& row, const std::optional<double>& best, double scale) {
  std::vector<double> costs, evaluations, seconds;
  for (const RunRecord* run : row.runs) {
    if (run->cost) costs.push_back(*run->cost);
    evaluations.push_back(static_cast<double>(run->evaluations));
    seconds.push_back(run->seconds);
  }
  std::vector<Cell> cells{text_cell(row.label), count_cell(static_cast<double>(row.runs.size())),
                          share_cell(static_cast<double>(row.runs.size() - costs.size()), row.runs.size())};
  for (double relative : {1e-6, 1e-2})
    cells.push_back(best ? share_cell(count_within(row, *best, scale, relative), row.runs.size()) : Cell{});
  append_spread(cells, costs, [](double v) { return significant_cell(v, kSpreadDigits); });
  append_spread(cells, evaluations, [](double v) { return significant_cell(v, 9); });
  append_spread(cells, seconds, [](double v) { return fixed_cell(v, 3); });
  return cells;
}

}  // namespace

bool has_costs(const Comparison& comparison) {
  return std::any_of(comparison.rows.begin(), comparison.rows.end(),
                     [](const ComparisonRow& row) { return row.kind != "evaluation" || row.shown->cost; });
}

Table solver_table(const Comparison& comparison) {
  Table table;
  table.id = comparison.id_prefix + "solvers";
  table.title = fmt::format("Solvers{}", comparison.title_suffix);
  const GapReference gap(comparison);
  table.columns = cost_columns(gap);
  table.columns.front().id = table.columns.front().name = "solver";
  const bool polished =
      std::any_of(comparison.rows.begin(), comparison.rows.end(),
                  [](const ComparisonRow& row) { return row.shown->cost_before_polish.has_value(); });
  if (polished) table.columns.push_back(number_column("cost_before_polish", "J unpolished", "", "cost"));
  table.columns.push_back(best_if(Better::Lower, number_column("evaluations", "evaluations", "", "effort")));
  table.columns.push_back(number_column("iterations", "iterations", "", "effort"));
  table.columns.push_back(best_if(Better::Lower, number_column("seconds", "time", "s", "effort")));
  table.columns.push_back(text_column("termination", "stop", "stop"));
  table.columns.push_back(text_column("message", "reason", "stop"));
  table.columns.push_back(text_column("active_bounds", "active bounds", "stop"));
  for (const ComparisonRow& row : comparison.rows) {
    add_reference(table, row);
    table.rows.push_back(solver_row(comparison, row, gap, polished));
  }
  table.notes.push_back(gap.note());
  if (const std::string median = median_note(comparison); !median.empty()) table.notes.push_back(median);
  return table;
}

Table cost_table(const Comparison& comparison) {
  Table table;
  table.id = comparison.id_prefix + "cost";
  table.title = fmt::format("Cost{}", comparison.title_suffix);
  const GapReference gap(comparison);
  table.columns = cost_columns(gap);
  table.columns.push_back(text_column("active_bounds"));
  const bool skipped = std::any_of(comparison.rows.begin(), comparison.rows.end(),
                                   [](const ComparisonRow& row) { return row.kind == "skipped"; });
  if (skipped) table.columns.push_back(text_column("message", "skipped because"));
  for (const ComparisonRow& row : comparison.rows) {
    add_reference(table, row);
    table.rows.push_back({text_cell(row.label), with_noise(cost_cell(row.shown->cost), cost_noise(row)),
                          ratio_to_nominal(comparison, *row.shown), gap.cell(row),
                          text_cell(active_bounds(*row.shown))});
    if (skipped) table.rows.back().push_back(text_cell(row.kind == "skipped" ? row.shown->message : ""));
  }
  if (comparison.rows.size() > 1) table.notes.push_back(gap.note());
  return table;
}

std::optional<Table> repeats_table(const Comparison& comparison) {
  Table table;
  table.id = comparison.id_prefix + "repeats";
  table.title = fmt::format("Spread over repeated runs{}", comparison.title_suffix);
  table.columns = {text_column("solver"), number_column("runs", "runs", "", "success"),
                   best_if(Better::Lower, number_column("failed", "failed", "", "success")),
                   best_if(Better::Higher, number_column("within_1e-6", "within 1e-6", "", "success")),
                   best_if(Better::Higher, number_column("within_1_percent", "within 1 %", "", "success"))};
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
