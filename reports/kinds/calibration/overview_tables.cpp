#include "reports/kinds/calibration/overview_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "reports/kinds/calibration/fit_table.hpp"
#include "reports/kinds/calibration/table_parts.hpp"
#include "reports/kinds/trust/trust_tables.hpp"
#include "reports/kinds/trust/validation_record.hpp"
#include "reports/statistics/statistics.hpp"

namespace odobench {
namespace {

constexpr int kPlainDigits = 3;  // of mm, and of numbers without an interval

Cell percent_cell(double value, double nominal) {
  const double change = change_percent(value, nominal);
  if (!std::isfinite(change)) return {};
  Cell cell = fixed_cell(change, 1);
  return cell;
}

Cell gap_cell(const Comparison& comparison, const ComparisonRow& row) {
  const std::optional<double> best = comparison.best_cost();
  if (row.kind != "run" || !row.shown->cost || !best || *best <= 0) return {};
  return unless_infinite(significant_cell((*row.shown->cost - *best) / *best, 2));
}

Cell bounds_cell(const RunRecord& record) {
  return count_cell(static_cast<double>(
      std::count_if(record.parameters.begin(), record.parameters.end(),
                    [](const ParameterValue& p) { return !p.at_bound.empty() && p.lower < p.upper; })));
}

Cell held_out_cell(const RunRecord& record) {
  const auto again = validation_of(record, kRepetitions);
  return again ? percent_cell(again->all.total_held_out, again->all.total_nominal) : Cell{};
}

std::vector<Cell> overview_row(const Comparison& comparison, const ComparisonRow& row) {
  const RunRecord& record = *row.shown;
  std::vector<Cell> cells{text_cell(row.label)};
  const std::vector<DriveFit> fits = drive_fits(record);
  if (fits.empty()) {
    cells.insert(cells.end(), 2, Cell{});
  } else {
    const DriveFit all = overall_fit(fits);
    cells.push_back(unless_infinite(fixed_cell(in_millimetres(all.rms_position), 1)));
    cells.push_back(unless_infinite(fixed_cell(in_degrees(all.rms_heading), 2)));
  }
  const bool run = row.kind == "run", compared = comparison.nominal() != nullptr && !row.errors.empty();
  cells.push_back(
      compared && &row != comparison.nominal()
          ? percent_cell(error_totals(row.errors).total, error_totals(comparison.nominal()->errors).total)
          : Cell{});
  cells.push_back(run ? held_out_cell(record) : Cell{});
  cells.push_back(gap_cell(comparison, row));
  cells.push_back(run && row.runs.size() > 1 ? count_cell(static_cast<double>(row.runs.size())) : Cell{});
  cells.push_back(run ? count_cell(static_cast<double>(record.evaluations)) : Cell{});
  cells.push_back(run ? fixed_cell(record.seconds, 3) : Cell{});
  cells.push_back(run ? bounds_cell(record) : Cell{});
  cells.push_back(text_cell(run                     ? record.termination
                            : row.kind == "skipped" ? "skipped: " + record.message
                                                    : ""));
  return cells;
}

std::vector<Column> overview_columns() {
  return {text_column("method"),
          number_column("rms_position", "position", "mm"),
          number_column("rms_heading", "heading", "deg"),
          number_column("total_change", "total error", "%"),
          number_column("held_out", "left out", "%"),
          number_column("gap", "J above best"),
          number_column("runs"),
          number_column("evaluations"),
          number_column("seconds", "time", "s"),
          number_column("bounds", "on bounds"),
          text_column("termination", "stop", "")};
}

const IntervalRecord* interval_of(const RunRecord& record, const std::string& name) {
  if (!record.trust) return nullptr;
  for (const ParameterIntervalRecord& p : record.trust->parameters)
    if (p.name == name) return &p.interval;
  return nullptr;
}

// "b 400.12 +- 0.35", "a1 350.000 (bound)"
std::string found_words(const RunRecord& record, const ParameterValue& p) {
  const double factor = read_unit(p.unit).factor;
  const IntervalRecord* interval = interval_of(record, p.name);
  const double half = interval == nullptr ? 0 : factor * interval->half_width;
  if (!p.at_bound.empty() || !(half > 0) || !std::isfinite(half)) {
    const std::string number =
        factor == 1 ? fmt::format("{:.6g}", p.value) : fmt::format("{:.{}f}", factor * p.value, kPlainDigits);
    return fmt::format("{} {}{}", p.name, number, p.at_bound.empty() ? "" : " (bound)");
  }
  const int digits = digits_of_half_width(half, kPlainDigits);
  return fmt::format("{} {:.{}f} +- {:.{}f}", p.name, factor * p.value, digits, half, digits);
}

}  // namespace

BestRun best_run(const Comparison& comparison) {
  BestRun best;
  for (const ComparisonRow& row : comparison.rows) {
    if (row.kind != "run") continue;
    for (const RunRecord* run : row.runs)
      if (run->cost && std::isfinite(*run->cost) &&
          (best.record == nullptr || *run->cost < *best.record->cost))
        best = {&row, run};
  }
  return best;
}

bool has_overview(const Comparison& comparison) {
  return std::any_of(comparison.rows.begin(), comparison.rows.end(),
                     [](const ComparisonRow& row) { return !row.errors.empty(); });
}

std::optional<Table> overview_table(const Comparison& comparison) {
  if (!has_overview(comparison)) return std::nullopt;
  Table table;
  table.id = comparison.id_prefix + "overview";
  table.title = "Methods: RMS of position and heading, total error against nominal" + comparison.title_suffix;
  table.columns = overview_columns();
  for (const ComparisonRow& row : comparison.rows) {
    add_reference(table, row);
    table.rows.push_back(overview_row(comparison, row));
  }
  for (std::size_t c = table.columns.size(); c-- > 1;)
    if (empty_column(table, c)) erase_column(table, c);
  table.key = true;
  return table;
}

std::optional<Table> found_table(const Comparison& comparison) {
  const BestRun best = best_run(comparison);
  if (best.record == nullptr || best.record->errors.empty() || best.record->parameters.empty())
    return std::nullopt;
  std::vector<std::pair<std::string, std::string>> by_unit;  // read unit, list
  for (const ParameterValue& p : best.record->parameters) {
    if (p.lower >= p.upper) continue;
    const std::string unit = read_unit(p.unit).name;
    auto at = std::find_if(by_unit.begin(), by_unit.end(), [&](const auto& u) { return u.first == unit; });
    if (at == by_unit.end()) at = by_unit.insert(by_unit.end(), {unit, ""});
    at->second += (at->second.empty() ? "" : ", ") + found_words(*best.record, p);
  }
  if (by_unit.empty()) return std::nullopt;
  Table table;
  table.id = comparison.id_prefix + "found";
  table.title = fmt::format("Parameters of {}{}", best.row->label, comparison.title_suffix);
  table.columns = {text_column("unit"), text_column("sentence")};
  table.sentences = "sentence";
  for (const auto& [unit, list] : by_unit)
    table.rows.push_back({text_cell(unit), text_cell(unit.empty() ? list : list + " " + unit)});
  table.key = true;
  return table;
}

}  // namespace odobench
