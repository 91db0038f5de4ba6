#include "reports/kinds/trust/noise_tables.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "reports/kinds/trust/noise_record.hpp"

namespace odobench {
namespace {

constexpr double kMillimetres = 1000, kDegrees = 57.29577951308232;

double root(double variance, double scale) {
  return scale * std::sqrt(std::max(0.0, variance));
}

std::vector<Cell> term_row(const NoiseTermName& name, const NoiseTermFigures& t) {
  const bool variance = name.root_unit[0] != '\0';
  std::vector<Cell> row{text_cell(name.meaning)};
  for (const double v : {t.value, t.lower, t.upper, t.total})
    row.push_back(variance ? significant_cell(root(v, name.root_scale), 3) : Cell{});
  row.push_back(text_cell(name.root_unit));
  row.push_back(significant_cell(t.value, 3));
  row.push_back(text_cell(t.unit));
  return row;
}

std::string verdict(const NoiseFigures& f) {
  if (!(f.checked > 0)) return "No drive could be left out: nothing has checked these numbers.";
  const char* word = f.consistent()          ? "the model holds"
                     : f.nees > f.nees_upper ? "the model is over-confident"
                                             : "the model is too cautious";
  return fmt::format(
      "End poses of {:.0f} left-out drives: NEES {:.2f} (3 expected, 95 % band {:.2f} .. {:.2f}): {}.",
      f.checked, f.nees, f.nees_lower, f.nees_upper, word);
}

std::string lengths_note(const NoiseFigures& f) {
  std::string text;
  for (const NoiseLengthFigures& l : f.lengths)
    text += fmt::format("{}{:.2f} at {:.2g} m + {:.2g} rad", text.empty() ? "" : ", ", l.ratio, l.metres,
                        l.radians);
  return "Squared errors over what the model says, by length of the parts (1: white): " + text + ".";
}

Table term_table(const Comparison& comparison, const ComparisonRow& row, const NoiseFigures& f) {
  Table table;
  table.id = comparison.id_prefix + "noise";
  table.title = fmt::format("Noise of the odometry itself: {}{}", row.label, comparison.title_suffix);
  table.columns = {text_column("term", "noise"),
                   number_column("deviation"),
                   number_column("lower"),
                   number_column("upper"),
                   number_column("total", "with bias"),
                   text_column("deviation_unit", "unit"),
                   number_column("variance"),
                   text_column("variance_unit", "of variance")};
  for (const NoiseTermName& name : kNoiseTermNames)
    if (const NoiseTermFigures* term = f.find(name.name);
        term != nullptr && (name.root_unit[0] != '\0' || term->value != 0))
      table.rows.push_back(term_row(name, *term));
  table.notes.push_back(
      "Standard deviation after one metre or radian; it grows with the root of the way. Lower, upper: 95 %. "
      "With bias: what repeats in every repetition counted as noise, for filters without a state for it.");
  if (!f.separated)
    table.notes.push_back(
        "No kind of drive was repeated often enough: what is systematic counts as noise here.");
  if (!f.lengths.empty()) table.notes.push_back(lengths_note(f));
  table.notes.push_back(verdict(f));
  return table;
}

Table kind_table(const Comparison& comparison, const ComparisonRow& row, const NoiseFigures& f) {
  Table table;
  table.id = comparison.id_prefix + "noise_kinds";
  table.title = fmt::format("What repeats and what does not, at the ends of the drives: {}{}", row.label,
                            comparison.title_suffix);
  table.columns = {text_column("kind"), number_column("drives")};
  for (const char* what : {"bias", "scatter", "predicted"})
    for (const char* of : {"x", "y", "heading"})
      table.columns.push_back(number_column(fmt::format("{}_{}", what, of), fmt::format("{} {}", what, of),
                                            of[0] == 'h' ? "deg" : "mm"));
  table.columns.push_back(number_column("nees", "NEES"));
  for (const NoiseKindFigures& k : f.kinds) {
    std::vector<Cell> cells{text_cell(k.kind), count_cell(k.drives)};
    const auto add = [&](double x, double y, double heading) {
      cells.push_back(fixed_cell(kMillimetres * x, 2));
      cells.push_back(fixed_cell(kMillimetres * y, 2));
      cells.push_back(fixed_cell(kDegrees * heading, 3));
    };
    add(k.bias_x, k.bias_y, k.bias_heading);
    add(k.scatter_x, k.scatter_y, k.scatter_heading);
    add(k.predicted_x, k.predicted_y, k.predicted_heading);
    cells.push_back(std::isfinite(k.nees) ? fixed_cell(k.nees, 2) : Cell{});
    table.rows.push_back(std::move(cells));
  }
  table.notes.push_back(
      "Odometry minus reference in the frame of the start. bias: mean over the repetitions, which is no "
      "noise; scatter: their standard deviation; predicted: that of the model; NEES: of left-out drives, 3 "
      "expected.");
  return table;
}

}  // namespace

std::vector<Table> noise_tables(const Comparison& comparison) {
  for (const ComparisonRow& row : comparison.rows)
    for (const RunRecord* record : row.runs)
      if (const std::optional<NoiseFigures> figures = noise_figures(*record))
        return {term_table(comparison, row, *figures), kind_table(comparison, row, *figures)};
  return {};
}

}  // namespace odobench
