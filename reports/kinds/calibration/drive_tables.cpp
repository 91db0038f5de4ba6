#include "reports/kinds/calibration/drive_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "base/angle.hpp"
#include "reports/figures/vega.hpp"
#include "reports/kinds/calibration/table_parts.hpp"
#include "reports/records/series.hpp"

namespace odobench {
namespace {

constexpr int kMetreDigits = 6, kDegreeDigits = 4;
constexpr std::size_t kMaxima = 4;  // the first of kDriveSeries

// The series of a record, null where one is missing.
using DriveFigures = std::array<const std::vector<double>*, kDriveSeries.size()>;

std::optional<DriveFigures> figures_of(const RunRecord& record) {
  DriveFigures found{};
  if (record.errors.empty()) return std::nullopt;
  for (std::size_t k = 0; k < found.size(); ++k) {
    found[k] = series_of(record, kDriveSeries[k], record.errors.size());
    if (found[k] == nullptr) return std::nullopt;
  }
  return found;
}

double shown_value(std::size_t figure, double value) {
  return figure % 2 == 0 ? value : value * 180 / kPi;
}

std::array<double, kMaxima> maxima_of(const DriveFigures& figures) {
  std::array<double, kMaxima> maxima{};
  for (std::size_t k = 0; k < kMaxima; ++k)
    for (const double value : *figures[k]) maxima[k] = std::max(maxima[k], shown_value(k, value));
  return maxima;
}

std::vector<Column> maxima_columns() {
  std::vector<Column> columns{number_column("max_position", "position max", "m", "anywhere"),
                              number_column("max_heading", "heading max", "deg", "anywhere"),
                              number_column("final_position", "position", "m", "end"),
                              number_column("final_heading", "heading", "deg", "end")};
  columns[2].name = "position end";
  columns[3].name = "heading end";
  for (Column& column : columns) column = best_if(Better::Lower, std::move(column));
  return columns;
}

Cell maximum_cell(std::size_t figure, double value, std::optional<double> nominal,
                  std::optional<double> noise) {
  Cell cell = fixed_cell(value, figure % 2 == 0 ? kMetreDigits : kDegreeDigits);
  if (nominal && std::isfinite(value - *nominal)) cell.difference = value - *nominal;
  cell.noise = noise;
  return unless_infinite(std::move(cell));
}

Table maxima_table(const Comparison& comparison) {
  Table table;
  table.id = comparison.id_prefix + "maxima";
  table.title = fmt::format("Largest errors in position and heading{}", comparison.title_suffix);
  table.columns = maxima_columns();
  table.columns.insert(table.columns.begin(), text_column("parameters"));
  const ComparisonRow* nominal = comparison.nominal();
  const auto before = nominal == nullptr ? std::nullopt : figures_of(*nominal->shown);
  for (const ComparisonRow& row : comparison.rows) {
    const auto figures = figures_of(*row.shown);
    if (!figures) continue;
    add_reference(table, row);
    std::vector<Cell> cells{text_cell(row.label)};
    const auto maxima = maxima_of(*figures);
    for (std::size_t k = 0; k < kMaxima; ++k) {
      const auto noise = noise_over_runs(row, [&](const RunRecord& run) -> std::optional<double> {
        const auto own = figures_of(run);
        return own ? std::optional<double>(maxima_of(*own)[k]) : std::nullopt;
      });
      const bool differs = before && &row != nominal;
      cells.push_back(maximum_cell(
          k, maxima[k], differs ? std::optional<double>(maxima_of(*before)[k]) : std::nullopt, noise));
    }
    table.rows.push_back(std::move(cells));
  }
  table.notes.push_back(
      "Distance from the reference in the plane and difference in heading, anywhere and at the end of a "
      "drive: "
      "maxima over the drives, as OptiOdom has them.");
  if (nominal != nullptr && table.rows.size() > 1)
    table.notes.push_back("In brackets: difference to the nominal parameters.");
  if (const std::string median = median_note(comparison); !median.empty()) table.notes.push_back(median);
  return table;
}

Table drives_table(const Comparison& comparison) {
  Table table;
  table.id = comparison.id_prefix + "drives";
  table.title = fmt::format("Largest errors of each drive{}", comparison.title_suffix);
  table.columns = maxima_columns();
  for (Column& column : table.columns) column.better = Better::None;  // rows are of different drives
  table.columns.insert(table.columns.begin(), {text_column("recording"), text_column("parameters")});
  std::vector<std::string> recordings;
  for (const ComparisonRow& row : comparison.rows)
    for (const RecordingError& e : row.shown->errors)
      if (std::find(recordings.begin(), recordings.end(), e.recording) == recordings.end())
        recordings.push_back(e.recording);
  for (const std::string& recording : recordings)
    for (const ComparisonRow& row : comparison.rows) {
      const auto figures = figures_of(*row.shown);
      if (!figures) continue;
      for (std::size_t i = 0; i < row.shown->errors.size(); ++i) {
        if (row.shown->errors[i].recording != recording) continue;
        std::vector<Cell> cells{text_cell(recording), text_cell(row.label)};
        for (std::size_t k = 0; k < kMaxima; ++k)
          cells.push_back(maximum_cell(k, shown_value(k, (*(*figures)[k])[i]), std::nullopt, std::nullopt));
        table.rows.push_back(std::move(cells));
      }
    }
  return table;
}

// End errors of the drives of one sense.
struct Ends {
  std::vector<double> x, y;

  double mean(const std::vector<double>& values) const {
    double sum = 0;
    for (const double v : values) sum += v;
    return sum / static_cast<double>(values.size());
  }
  double distance() const { return std::hypot(mean(x), mean(y)); }
  // About the centre; one drive has none.
  Cell spread_cell() const {
    if (x.size() < 2) return {};
    double sum = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
      sum += (x[i] - mean(x)) * (x[i] - mean(x)) + (y[i] - mean(y)) * (y[i] - mean(y));
    return unless_infinite(fixed_cell(std::sqrt(sum / static_cast<double>(x.size() - 1)), kMetreDigits));
  }
};

// Clockwise and counter-clockwise; none without both.
std::optional<std::array<Ends, 2>> ends_of(const RunRecord& record) {
  const auto figures = figures_of(record);
  if (!figures) return std::nullopt;
  std::array<Ends, 2> ends;
  for (std::size_t i = 0; i < record.errors.size(); ++i) {
    const double sense = (*(*figures)[6])[i];
    if (sense == 0) continue;
    Ends& own = ends[sense > 0 ? 1 : 0];
    own.x.push_back((*(*figures)[4])[i]);
    own.y.push_back((*(*figures)[5])[i]);
  }
  if (ends[0].x.empty() || ends[1].x.empty()) return std::nullopt;
  return ends;
}

// The end errors of all rows, and their chart with one scale for both axes, 0 among what is shown.
struct EndPoints {
  std::vector<std::string> labels;
  std::string csv = "s,sense,kind,x,y\n";
  std::array<double, 2> low{}, high{};

  void add(const std::string& label, const std::array<Ends, 2>& ends) {
    for (std::size_t sense = 0; sense < 2; ++sense) {
      const Ends& e = ends[sense];
      for (std::size_t i = 0; i < e.x.size(); ++i) add(sense, "drive", e.x[i], e.y[i]);
      add(sense, "centre", e.mean(e.x), e.mean(e.y));
    }
    labels.push_back(label);
  }

  vega::json chart() const {
    using vega::json;
    constexpr double kSide = 440;  // px
    const double span = 1.1 * std::max({high[0] - low[0], high[1] - low[1], 1e-9});
    json axes[2] = {vega::quantitative("x", "end error x [m]"), vega::quantitative("y", "end error y [m]")};
    for (std::size_t c = 0; c < 2; ++c) {
      const double middle = (low[c] + high[c]) / 2;
      axes[c]["scale"] = {{"domain", {middle - span / 2, middle + span / 2}}, {"nice", false}};
    }
    const json encoding{{"x", axes[0]},
                        {"y", axes[1]},
                        {"color", vega::nominal("label", "", labels)},
                        {"shape", vega::nominal("sense", "", {"clockwise", "counter-clockwise"})}};
    const auto layer = [&](const char* kind, int size, double opacity) {
      const json mark{
          {"type", "point"}, {"filled", true}, {"size", size}, {"opacity", opacity}, {"tooltip", true}};
      return json{{"transform", {vega::filter(fmt::format("datum.kind == '{}'", kind))}},
                  {"mark", mark},
                  {"encoding", encoding}};
    };
    return {{"width", kSide},
            {"height", kSide},
            {"transform",
             {vega::name_of("s", labels, "label"), vega::filter("method == 'all' || datum.label == method")}},
            {"layer", json::array({layer("drive", 30, 0.6), layer("centre", 220, 1)})}};
  }

 private:
  void add(std::size_t sense, const char* kind, double x, double y) {
    fmt::format_to(std::back_inserter(csv), "{},{},{},{:.6g},{:.6g}\n", labels.size(),
                   sense == 0 ? "clockwise" : "counter-clockwise", kind, x, y);
    const double at[] = {x, y};
    for (std::size_t c = 0; c < 2; ++c)
      if (std::isfinite(at[c])) low[c] = std::min(low[c], at[c]), high[c] = std::max(high[c], at[c]);
  }
};

std::optional<Table> ends_table(const Comparison& comparison) {
  Table table;
  table.id = comparison.id_prefix + "ends";
  table.title = fmt::format("Ends of drives in both senses{}", comparison.title_suffix);
  table.columns = {text_column("parameters"),
                   best_if(Better::Lower,
                           number_column("E_max_syst", "E_max,syst", "m", "", "$E_{\\max,\\mathrm{syst}}$"))};
  for (const char* const sense : {"cw", "ccw"}) {
    for (const char* const part : {"x", "y", "r"})
      table.columns.push_back(number_column(fmt::format("{}_{}", part, sense), "", "m", sense));
    table.columns.push_back(number_column(fmt::format("spread_{}", sense), "", "m", sense));
  }
  std::array<std::size_t, 2> drives{};
  for (const ComparisonRow& row : comparison.rows) {
    const auto ends = ends_of(*row.shown);
    if (!ends) continue;
    drives = {(*ends)[0].x.size(), (*ends)[1].x.size()};
    add_reference(table, row);
    Cell worst = fixed_cell(std::max((*ends)[0].distance(), (*ends)[1].distance()), kMetreDigits);
    worst.noise = noise_over_runs(row, [](const RunRecord& run) -> std::optional<double> {
      const auto own = ends_of(run);
      if (!own) return std::nullopt;
      return std::max((*own)[0].distance(), (*own)[1].distance());
    });
    std::vector<Cell> cells{text_cell(row.label), unless_infinite(std::move(worst))};
    for (const Ends& e : *ends) {
      for (const double value : {e.mean(e.x), e.mean(e.y), e.distance()})
        cells.push_back(unless_infinite(fixed_cell(value, kMetreDigits)));
      cells.push_back(e.spread_cell());
    }
    table.rows.push_back(std::move(cells));
  }
  if (table.rows.empty()) return std::nullopt;
  table.notes.push_back(fmt::format(
      "End error: reference minus odometry at the end, seen from the start; x, y: its mean over the {} "
      "drives "
      "clockwise (cw), {} counter-clockwise (ccw); r: distance of that centre from 0; E_max,syst: the larger "
      "r, "
      "UMBmark's measure where the drives are closed squares; spread: standard deviation about the centre.",
      drives[0], drives[1]));
  return table;
}

}  // namespace

std::vector<Table> drive_tables(const Comparison& comparison) {
  std::size_t rows = 0;
  for (const ComparisonRow& row : comparison.rows)
    if (figures_of(*row.shown)) rows += row.shown->errors.size();
  if (rows == 0) return {};
  std::vector<Table> tables{maxima_table(comparison)};
  if (rows <= kMostDriveRows)
    tables.push_back(drives_table(comparison));
  else
    tables.back().notes.push_back(
        fmt::format("Drive by drive they are in the records: {} rows would be too long a table.", rows));
  if (auto ends = ends_table(comparison)) tables.push_back(std::move(*ends));
  return tables;
}

void add_end_figure(const Comparison& comparison, const std::string& prefix, Section& section,
                    Document& document) {
  EndPoints points;
  for (const ComparisonRow& row : comparison.rows)
    if (const auto ends = ends_of(*row.shown)) points.add(row.label, *ends);
  if (points.labels.empty()) return;
  const std::string id = prefix + "ends";
  document.datasets[id] = points.csv;
  const std::string caption =
      "End errors y over x in metres, reference minus odometry seen from the start: a small sign per drive, "
      "a large one for the centre of each sense. UMBmark's E_max,syst is the distance of the farther centre "
      "from 0.";
  vega::json spec = vega::specification(caption, vega::csv_data(id, {"s", "x", "y"}),
                                        {vega::choice_of("method", "Method", "all methods", points.labels)},
                                        points.chart());
  spec["usermeta"]["odobench"]["aspect"] = "equal";
  section.blocks.push_back(Figure{id, fmt::format("End errors with both centres{}", comparison.title_suffix),
                                  caption, std::move(spec)});
}

}  // namespace odobench
