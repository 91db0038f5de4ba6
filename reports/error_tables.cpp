#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "reports/table_parts.hpp"

namespace odobench {
namespace {

constexpr int kDigits = 6;  // as in the thesis

constexpr std::array<const char*, 3> kUnits{"m", "m", "rad"};
constexpr std::array<const char*, 3> kShort{"x", "y", "θ"};
constexpr std::array<const char*, 3> kLatex{"x", "y", "\\theta"};

constexpr const char* kDefinition =
    "e_max, e_sr, σ: maximum, mean and sample standard deviation (n-1) over the repetitions of the largest "
    "|estimate - reference| of a recording.";

Column key_column(const char* id) {
  Column column;
  column.id = id;
  column.name = id;
  column.align = Align::Left;
  return column;
}

std::vector<Column> error_columns() {
  std::vector<Column> columns;
  for (std::size_t v = 0; v < 3; ++v) {
    const std::string id = kPoseVariables[v], name = kShort[v], latex = kLatex[v];
    columns.push_back({"e_max_" + id, fmt::format("e_{},max", name), kUnits[v],
                       fmt::format("$e_{{{},\\max}}$", latex), id});
    columns.push_back({"e_sr_" + id, fmt::format("e_{},sr", name), kUnits[v],
                       fmt::format("$e_{{{},\\mathrm{{sr}}}}$", latex), id});
    columns.push_back(
        {"sigma_" + id, fmt::format("σ_{}", name), kUnits[v], fmt::format("$\\sigma_{{{}}}$", latex), id});
  }
  return columns;
}

Cell error_cell(double value, const double* reference) {
  Cell cell = fixed_cell(value, kDigits);
  if (reference != nullptr && !std::isnan(*reference) && !std::isnan(value))
    cell.difference = value - *reference;
  return cell;
}

void append_cells(std::vector<Cell>& row, const TrajectoryErrors* errors, const TrajectoryErrors* reference) {
  if (errors == nullptr) {
    row.insert(row.end(), 9, Cell{});
    return;
  }
  for (std::size_t v = 0; v < 3; ++v) {
    const ErrorStatistics& e = errors->variables[v];
    const ErrorStatistics* r = reference == nullptr ? nullptr : &reference->variables[v];
    row.push_back(error_cell(e.max, r == nullptr ? nullptr : &r->max));
    row.push_back(error_cell(e.mean, r == nullptr ? nullptr : &r->mean));
    // A single repetition has no standard deviation; a broken one shows as nan in all three.
    const bool single = std::isnan(e.sigma) && !std::isnan(e.mean);
    row.push_back(single ? Cell{} : error_cell(e.sigma, r == nullptr ? nullptr : &r->sigma));
  }
}

// Labels without errors (skipped, failed) have no place in these tables; the solver table says why.
bool belongs(const ComparisonRow& row) {
  return !row.errors.empty();
}

Table trajectory_table(const Comparison& comparison, const std::string& trajectory) {
  Table table;
  table.id = comparison.id_prefix + "errors." + trajectory;
  table.title = fmt::format("Errors on trajectory {}{}", trajectory, comparison.title_suffix);
  table.columns.push_back(key_column("parameters"));
  for (Column& column : error_columns()) table.columns.push_back(best_if(Better::Lower, std::move(column)));
  const ComparisonRow* nominal = comparison.nominal();
  const TrajectoryErrors* reference = nominal ? find_trajectory(nominal->errors, trajectory) : nullptr;
  for (const ComparisonRow& row : comparison.rows) {
    if (!belongs(row)) continue;
    add_reference(table, row);
    std::vector<Cell> cells{text_cell(row.label)};
    append_cells(cells, find_trajectory(row.errors, trajectory), &row == nominal ? nullptr : reference);
    table.rows.push_back(std::move(cells));
  }
  return table;
}

std::vector<std::string> common_notes(const Comparison& comparison) {
  std::vector<std::string> notes;
  const std::string median = median_note(comparison);
  if (!median.empty()) notes.push_back(median);
  return notes;
}

Column sum_column(std::string id, std::string name, std::string unit, std::string latex) {
  return best_if(Better::Lower, {std::move(id), std::move(name), std::move(unit), std::move(latex), "sum"});
}

// Sums over different trajectories must not be compared.
bool complete(const ComparisonRow& row, const Comparison& comparison) {
  return row.errors.size() == comparison.trajectories.size();
}

std::vector<Cell> totals_row(const ComparisonRow& row, const Comparison& comparison) {
  std::vector<Cell> cells{text_cell(row.label)};
  if (!complete(row, comparison)) {
    cells.insert(cells.end(), 6, Cell{});
    return cells;
  }
  const Totals totals = error_totals(row.errors);
  for (double sum : totals.sums) cells.push_back(fixed_cell(sum, kDigits));
  cells.push_back(fixed_cell(totals.total, kDigits));
  const ComparisonRow* nominal = comparison.nominal();
  if (nominal == nullptr || &row == nominal || !complete(*nominal, comparison)) {
    cells.insert(cells.end(), 2, Cell{});
    return cells;
  }
  const double before = error_totals(nominal->errors).total;
  cells.push_back(fixed_cell(totals.total - before, kDigits));
  cells.push_back(before > 0 ? fixed_cell(100 * (totals.total - before) / before, 2) : Cell{});
  return cells;
}

}  // namespace

void add_reference(Table& table, const ComparisonRow& row) {
  if (row.kind == "evaluation" && row.label == "nominal") table.references.push_back(table.rows.size());
}

std::vector<Table> error_tables(const Comparison& comparison) {
  std::vector<Table> tables;
  for (const std::string& trajectory : comparison.trajectories)
    tables.push_back(trajectory_table(comparison, trajectory));
  if (tables.empty()) return tables;
  // Said once, below the last one.
  auto& notes = tables.back().notes;
  notes.push_back(kDefinition);
  if (comparison.nominal() != nullptr &&
      std::count_if(comparison.rows.begin(), comparison.rows.end(), belongs) > 1)
    notes.push_back("In brackets: difference to the nominal parameters.");
  for (std::string& note : common_notes(comparison)) notes.push_back(std::move(note));
  return tables;
}

std::optional<Table> error_overview(const Comparison& comparison) {
  if (comparison.trajectories.empty()) return std::nullopt;
  const ComparisonRow& row = comparison.rows.front();
  Table table;
  table.id = comparison.id_prefix + "errors";
  table.title = fmt::format("Errors of parameters {}{}", row.label, comparison.title_suffix);
  table.columns.push_back(key_column("trajectory"));
  for (Column& column : error_columns()) table.columns.push_back(std::move(column));
  for (const TrajectoryErrors& trajectory : row.errors) {
    std::vector<Cell> cells{text_cell(trajectory.trajectory)};
    append_cells(cells, &trajectory, nullptr);
    table.rows.push_back(std::move(cells));
  }
  table.notes.push_back(kDefinition);
  for (std::string& note : common_notes(comparison)) table.notes.push_back(std::move(note));
  return table;
}

std::optional<Table> totals_table(const Comparison& comparison) {
  if (comparison.trajectories.empty()) return std::nullopt;
  Table table;
  table.id = comparison.id_prefix + "totals";
  table.title = fmt::format("Total error{}", comparison.title_suffix);
  table.columns = {key_column("parameters"),
                   sum_column("sum_e_sr_x", "Σ e_x,sr", "m", "$\\sum e_{x,\\mathrm{sr}}$"),
                   sum_column("sum_e_sr_y", "Σ e_y,sr", "m", "$\\sum e_{y,\\mathrm{sr}}$"),
                   sum_column("sum_e_sr_theta", "Σ e_θ,sr", "rad", "$\\sum e_{\\theta,\\mathrm{sr}}$"),
                   sum_column("total", "total", "", ""),
                   {"change", "change", "", "", "change"},
                   {"change_percent", "change", "%", "", "change"}};
  for (const ComparisonRow& row : comparison.rows) {
    if (!belongs(row)) continue;
    add_reference(table, row);
    table.rows.push_back(totals_row(row, comparison));
  }
  table.notes.push_back(
      fmt::format("Sums of e_sr over {} trajectories; the total adds metres and radians, as in the thesis; "
                  "change: to nominal.",
                  comparison.trajectories.size()));
  for (std::string& note : common_notes(comparison)) table.notes.push_back(std::move(note));
  return table;
}

}  // namespace odobench
