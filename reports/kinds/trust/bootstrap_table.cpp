#include "reports/kinds/trust/bootstrap_table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "reports/kinds/trust/bootstrap_record.hpp"

namespace odobench {
namespace {

// Lengths in mm, as in the table of parameters.
std::vector<Cell> spread_cells(double fit, const BootstrapSpread& spread, bool metres) {
  const double scale = metres ? 1000 : 1;
  const auto cell = [&](double value) {
    if (std::isinf(scale * value)) return Cell{};
    return metres ? fixed_cell(scale * value, 3) : significant_cell(value, 6);
  };
  std::vector<Cell> cells{cell(fit)};
  for (const double value : spread.percentiles) cells.push_back(cell(value));
  cells.push_back(std::isfinite(spread.deviation) ? significant_cell(scale * spread.deviation, 3) : Cell{});
  return cells;
}

void add_row(const std::string& name, const std::string& unit, std::vector<Cell> spread, Cell share,
             Table& table) {
  std::vector<Cell> cells{text_cell(name), text_cell(unit)};
  for (Cell& cell : spread) cells.push_back(std::move(cell));
  cells.push_back(std::move(share));
  table.rows.push_back(std::move(cells));
}

void add_rows(const RunRecord& record, const BootstrapFigures& figures, Table& table) {
  add_row("J", "", spread_cells(record.cost.value_or(0), cost_spread(figures), false), {}, table);
  std::string bounded;
  for (std::size_t i = 0; i < record.parameters.size(); ++i) {
    const ParameterValue& p = record.parameters[i];
    const BootstrapSpread spread = parameter_spread(figures, record, i);
    const bool metres = p.unit == "m";
    add_row(p.name, metres ? "mm" : p.unit, spread_cells(p.value, spread, metres),
            fixed_cell(100 * spread.share_at_bound, 1), table);
    if (spread.share_at_bound > 0 && p.lower < p.upper) bounded += (bounded.empty() ? "" : ", ") + p.name;
  }
  if (!bounded.empty())
    table.notes.push_back(
        fmt::format("On a bound in some resamples: {}. The box holds their spread back; a spread of 0 there "
                    "is the bound, "
                    "not precision.",
                    bounded));
}

Table table_of(const RunRecord& record, const BootstrapFigures& figures, const Comparison& comparison) {
  Table table;
  table.id = comparison.id_prefix + "bootstrap";
  table.key = true;
  table.title = fmt::format("Bootstrap of {}: {} {} resamples{}", record.label, figures.replicates(),
                            figures.scheme, comparison.title_suffix);
  table.columns = {text_column("quantity"),
                   text_column("unit"),
                   number_column("fit"),
                   number_column("p2_5", "2.5 %"),
                   number_column("p50", "50 %"),
                   number_column("p97_5", "97.5 %"),
                   number_column("deviation", "sd"),
                   number_column("at_bound_percent", "on a bound", "%")};
  add_rows(record, figures, table);
  table.notes.push_back(
      figures.scheme == "stratified"
          ? "Each resample draws, with replacement, from every kind of drive as many recordings as it has."
          : "Each resample draws as many recordings as there are, with replacement.");
  return table;
}

}  // namespace

std::optional<Table> bootstrap_table(const Comparison& comparison) {
  for (const ComparisonRow& row : comparison.rows)
    for (const RunRecord* run : row.runs)
      if (const std::optional<BootstrapFigures> figures = bootstrap_of(*run))
        return table_of(*run, *figures, comparison);
  return std::nullopt;
}

}  // namespace odobench
