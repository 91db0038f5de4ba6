#include "reports/kinds/trust/loss_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "reports/records/series.hpp"

namespace odobench {
namespace {

constexpr double kOutlier = 6;

// Of the row with the lowest J that ran, else of the first one that has the series.
const ComparisonRow* weighing_row(const Comparison& comparison) {
  const ComparisonRow* best = nullptr;
  for (const ComparisonRow& row : comparison.rows) {
    if (row.shown->series.count(kWeightedDownSeries[0]) == 0) continue;
    const bool nominal = &row == comparison.nominal(),
               best_is_nominal = best != nullptr && best == comparison.nominal();
    if (best == nullptr || best_is_nominal ||
        (!nominal && row.shown->cost && best->shown->cost && *row.shown->cost < *best->shown->cost))
      best = &row;
  }
  return best;
}

std::string scale_note(const RunRecord& record) {
  const auto of = [&](const char* name) { return record.measures.value(name); };
  if (const auto one = of("loss.recording_scale"))
    return fmt::format("Scale of the loss: {:.4g} per recording.", *one);
  const auto position = of("loss.position_scale"), heading = of("loss.heading_scale");
  if (!position || !heading) return "";
  return fmt::format("Scales of the loss: {:.4g} m, {:.4g} rad.", *position, *heading);
}

}  // namespace

std::string set_aside_measure(const std::string& recording, const char* what) {
  return fmt::format("set_aside.{}.{}", recording, what);
}

std::optional<Table> weighted_down_table(const Comparison& comparison) {
  const ComparisonRow* row = weighing_row(comparison);
  if (row == nullptr) return std::nullopt;
  const RunRecord& record = *row->shown;
  const std::size_t count = record.series.at(kWeightedDownSeries[0]).size();
  std::array<const std::vector<double>*, kWeightedDownSeries.size()> series{};
  for (std::size_t k = 0; k < series.size(); ++k) {
    series[k] = series_of(record, kWeightedDownSeries[k], count);
    if (series[k] == nullptr) return std::nullopt;
  }
  Table table;
  table.id = comparison.id_prefix + "weighted_down";
  table.title = fmt::format("What the loss counts for less: {}{}", row->label, comparison.title_suffix);
  table.columns = {text_column("recording"),
                   text_column("part"),
                   number_column("first", "first sample"),
                   number_column("last", "last sample"),
                   number_column("ratio", "RMS / median"),
                   number_column("weight"),
                   text_column("remark")};
  for (std::size_t i = 0; i < count; ++i) {
    const auto index = static_cast<std::size_t>((*series[0])[i]);
    if (index >= record.errors.size()) return std::nullopt;
    const bool whole = !std::isfinite((*series[3])[i]);
    const double ratio = (*series[1])[i];
    table.rows.push_back({text_cell(record.errors[index].recording), text_cell(whole ? "all" : "stretch"),
                          whole ? Cell{} : count_cell((*series[3])[i]),
                          whole ? Cell{} : count_cell((*series[4])[i]), significant_cell(ratio, 4),
                          significant_cell((*series[2])[i], 3),
                          text_cell(whole && ratio > kOutlier ? "outlier" : "")});
  }
  table.notes.push_back(
      "The recordings with the largest RMS error, an outlier from 6 times the median on, with their mean "
      "weight; then stretches of samples that weigh less than 0.1, with the lowest weight, the longest five "
      "of a recording.");
  if (const std::string note = scale_note(record); !note.empty()) table.notes.push_back(note);
  return table;
}

std::optional<Table> set_aside_table(const Comparison& comparison) {
  Table table;
  table.id = comparison.id_prefix + "set_aside";
  table.title = fmt::format("Left out of the calibration{}", comparison.title_suffix);
  table.columns = {text_column("recording"),
                   number_column("times_usual", "times the usual"),
                   text_column("parameters"),
                   number_column("x", "largest x", "m"),
                   number_column("y", "largest y", "m"),
                   number_column("heading", "largest heading", "rad")};
  std::vector<std::string> names;
  for (const ComparisonRow& row : comparison.rows)
    for (const std::string& name : row.shown->measures.subjects())
      if (row.shown->measures.find(set_aside_measure(name, "z")) != nullptr &&
          std::find(names.begin(), names.end(), name) == names.end())
        names.push_back(name);
  if (names.empty()) return std::nullopt;
  for (const std::string& name : names)
    for (const ComparisonRow& row : comparison.rows) {
      const auto of = [&](const char* what) {
        return row.shown->measures.value(set_aside_measure(name, what));
      };
      if (!of("z")) continue;
      const auto error = [&](const char* what) { return of(what) ? fixed_cell(*of(what), 6) : Cell{}; };
      table.rows.push_back({text_cell(name), significant_cell(*of("z"), 3), text_cell(row.label), error("x"),
                            error("y"), error("heading")});
    }
  table.notes.push_back(fmt::format(
      "{} recording{} from the siblings, and {} no part in J, errors and totals of the other "
      "tables; --screen=off keeps everything.",
      names.size(), names.size() == 1 ? " differs" : "s differ", names.size() == 1 ? "has" : "have"));
  return table;
}

}  // namespace odobench
