#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <optional>

#include "reports/kinds/calibration/table_parts.hpp"

namespace odobench {
namespace {

constexpr int kDigits = 6;  // as in the thesis

constexpr std::array<const char*, 3> kUnits{"m", "m", "rad"};
constexpr std::array<const char*, 3> kShort{"x", "y", "θ"};
constexpr std::array<const char*, 3> kLatex{"x", "y", "\\theta"};

constexpr const char* kDefinition =
    "e_max, e_sr, σ: maximum, mean and sample standard deviation (n-1) over the repetitions of the largest "
    "|estimate - reference| of a recording.";

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

// The errors of every run of a row, for what repetitions change about them.
class ErrorNoise {
 public:
  explicit ErrorNoise(const ComparisonRow& row) : row_(row) {
    if (row.runs.size() < 2) return;
    for (const RunRecord* run : row.runs) all_[run] = error_statistics(run->errors);
  }
  using FigureOfErrors = std::function<std::optional<double>(const std::vector<TrajectoryErrors>&)>;
  std::optional<double> of(const FigureOfErrors& figure) const {
    return noise_over_runs(row_, [&](const RunRecord& run) -> std::optional<double> {
      const auto found = all_.find(&run);
      return found == all_.end() || found->second.empty() ? std::nullopt : figure(found->second);
    });
  }
  std::optional<double> of(const std::string& trajectory, std::size_t v,
                           double ErrorStatistics::*part) const {
    return of([&](const std::vector<TrajectoryErrors>& errors) -> std::optional<double> {
      const TrajectoryErrors* e = find_trajectory(errors, trajectory);
      return e == nullptr ? std::nullopt : std::optional<double>(e->variables[v].*part);
    });
  }
  std::optional<double> of_total(std::optional<std::size_t> v) const {
    return of([&](const std::vector<TrajectoryErrors>& errors) -> std::optional<double> {
      const Totals totals = error_totals(errors);
      return v ? totals.sums[*v] : totals.total;
    });
  }

 private:
  const ComparisonRow& row_;
  std::map<const RunRecord*, std::vector<TrajectoryErrors>> all_;
};

Cell error_cell(double value, const double* reference, std::optional<double> noise) {
  Cell cell = fixed_cell(value, kDigits);
  cell.noise = noise;
  if (reference != nullptr && std::isfinite(value - *reference)) cell.difference = value - *reference;
  return unless_infinite(std::move(cell));
}

void append_cells(std::vector<Cell>& row, const TrajectoryErrors* errors, const TrajectoryErrors* reference,
                  const ErrorNoise& noise) {
  if (errors == nullptr) {
    row.insert(row.end(), 9, Cell{});
    return;
  }
  for (std::size_t v = 0; v < 3; ++v) {
    const ErrorStatistics& e = errors->variables[v];
    const ErrorStatistics* r = reference == nullptr ? nullptr : &reference->variables[v];
    const auto cell = [&](double ErrorStatistics::*part) {
      return error_cell(e.*part, r == nullptr ? nullptr : &(r->*part), noise.of(errors->trajectory, v, part));
    };
    row.push_back(cell(&ErrorStatistics::max));
    row.push_back(cell(&ErrorStatistics::mean));
    // A single repetition has no standard deviation; a broken one shows as nan in all three.
    const bool single = std::isnan(e.sigma) && !std::isnan(e.mean);
    row.push_back(single ? Cell{} : cell(&ErrorStatistics::sigma));
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
  table.columns.push_back(text_column("parameters"));
  for (Column& column : error_columns()) table.columns.push_back(best_if(Better::Lower, std::move(column)));
  const ComparisonRow* nominal = comparison.nominal();
  const TrajectoryErrors* reference = nominal ? find_trajectory(nominal->errors, trajectory) : nullptr;
  for (const ComparisonRow& row : comparison.rows) {
    if (!belongs(row)) continue;
    add_reference(table, row);
    std::vector<Cell> cells{text_cell(row.label)};
    append_cells(cells, find_trajectory(row.errors, trajectory), &row == nominal ? nullptr : reference,
                 ErrorNoise(row));
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
    cells.insert(cells.end(), 7, Cell{});
    return cells;
  }
  const Totals totals = error_totals(row.errors);
  const ErrorNoise noise(row);
  for (std::size_t v = 0; v < 3; ++v) {
    cells.push_back(unless_infinite(fixed_cell(totals.sums[v], kDigits)));
    cells.back().noise = noise.of_total(v);
  }
  cells.push_back(unless_infinite(fixed_cell(totals.total, kDigits)));
  cells.back().noise = noise.of_total(std::nullopt);
  const ComparisonRow* nominal = comparison.nominal();
  if (nominal == nullptr || &row == nominal || !complete(*nominal, comparison)) {
    cells.insert(cells.end(), 3, Cell{});
    return cells;
  }
  const double before = error_totals(nominal->errors).total;
  if (std::isinf(totals.total) || std::isinf(before)) {
    cells.insert(cells.end(), 2, Cell{});
  } else {
    cells.push_back(fixed_cell(totals.total - before, kDigits));
    const double percent = 100 * (totals.total - before) / before;
    cells.push_back(before > 0 ? unless_infinite(fixed_cell(percent, 2)) : Cell{});
  }
  const WorseMeans worse = worse_means(row, *nominal);
  cells.push_back(text_cell(fmt::format("{} of {}", worse.worse, worse.all)));
  return cells;
}

}  // namespace

WorseMeans worse_means(const ComparisonRow& row, const ComparisonRow& nominal) {
  WorseMeans count;
  for (const TrajectoryErrors& errors : row.errors) {
    const TrajectoryErrors* before = find_trajectory(nominal.errors, errors.trajectory);
    if (before == nullptr) continue;
    for (std::size_t v = 0; v < 3; ++v) {
      const double now = errors.variables[v].mean, then = before->variables[v].mean;
      ++count.all;
      if (!(now <= then * (1 + kRepeats))) ++count.worse;
    }
  }
  return count;
}

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
  table.columns.push_back(text_column("trajectory"));
  for (Column& column : error_columns()) table.columns.push_back(std::move(column));
  for (const TrajectoryErrors& trajectory : row.errors) {
    std::vector<Cell> cells{text_cell(trajectory.trajectory)};
    append_cells(cells, &trajectory, nullptr, ErrorNoise(row));
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
  table.columns = {text_column("parameters"),
                   sum_column("sum_e_sr_x", "Σ e_x,sr", "m", "$\\sum e_{x,\\mathrm{sr}}$"),
                   sum_column("sum_e_sr_y", "Σ e_y,sr", "m", "$\\sum e_{y,\\mathrm{sr}}$"),
                   sum_column("sum_e_sr_theta", "Σ e_θ,sr", "rad", "$\\sum e_{\\theta,\\mathrm{sr}}$"),
                   sum_column("total", "total", "", ""),
                   {"change", "change", "", "", "change"},
                   {"change_percent", "change", "%", "", "change"},
                   {"worse_means", "means worse", "", "", "change"}};
  for (const ComparisonRow& row : comparison.rows) {
    if (!belongs(row)) continue;
    add_reference(table, row);
    table.rows.push_back(totals_row(row, comparison));
  }
  table.notes.push_back(
      fmt::format("Sums of e_sr over {} trajectories; the total adds metres and radians, as in the thesis; "
                  "change: to nominal. Means worse: mean errors e_sr above the nominal ones.",
                  comparison.trajectories.size()));
  for (std::string& note : common_notes(comparison)) table.notes.push_back(std::move(note));
  return table;
}

}  // namespace odobench
