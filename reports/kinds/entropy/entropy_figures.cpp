#include "reports/kinds/entropy/entropy_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>

#include "reports/figures/vega.hpp"
#include "reports/kinds/entropy/entropy_tables.hpp"

namespace odobench {
namespace {

using vega::json;

const std::vector<std::string>& stage_names() {
  static const std::vector<std::string> names(kSignalStages.begin(), kSignalStages.end());
  return names;
}

const std::vector<double>* series_of(const RunRecord& record, const std::string& name) {
  const auto found = record.series.find(name);
  return found == record.series.end() || found->second.empty() ? nullptr : &found->second;
}

std::string panel_title(const NoiseChannel& signal) {
  return fmt::format("{} [{}]", signal.name, signal.unit);
}

// The panels of the signals one below the other; `panel` gives the layers of one.
template <class Panel>
json signal_panels(const Panel& panel) {
  json views = json::array();
  for (std::size_t c = 0; c < kSignals.size(); ++c)
    views.push_back({{"width", kFigureWidth},
                     {"height", 130},
                     {"transform", {vega::filter(fmt::format("datum.c == {}", c))}},
                     {"layer", panel(kSignals[c], c + 1 == kSignals.size() ? "row" : "")}});
  return views;
}

void add_bands(const RunRecord& record, const std::string& prefix, Section& section, Document& document) {
  const std::vector<double>* width = series_of(record, "signal.width");
  if (width == nullptr) return;
  std::string csv = "c,stage,row,min,max\n";
  for (std::size_t c = 0; c < kSignals.size(); ++c)
    for (const std::string& stage : stage_names()) {
      const std::string name = fmt::format("signal.{}.{}", kSignals[c].id, stage);
      const std::vector<double>* low = series_of(record, name + ".min");
      const std::vector<double>* high = series_of(record, name + ".max");
      if (low == nullptr || high == nullptr || low->size() != high->size()) continue;
      for (std::size_t b = 0; b < low->size(); ++b)
        fmt::format_to(std::back_inserter(csv), "{},{},{:.0f},{:.6g},{:.6g}\n", c, stage,
                       static_cast<double>(b) * width->front(), (*low)[b], (*high)[b]);
    }
  const std::string id = prefix + "signals";
  document.datasets[id] = csv;
  const std::string caption =
      "Wheels: displacement per row, mean of the four; rotation per row. " +
      (width->front() == 1
           ? std::string("Every row is drawn.")
           : fmt::format("Bands from the smallest to the largest value in {:.0f} rows: no extreme is hidden.",
                         width->front()));
  const auto panel = [](const NoiseChannel& signal, const std::string& x_title) {
    const json x = vega::quantitative("row", x_title);
    json y = vega::quantitative("min", panel_title(signal));
    return json::array({{{"mark", {{"type", "area"}, {"opacity", 0.45}, {"line", true}}},
                         {"encoding",
                          {{"x", x},
                           {"y", y},
                           {"y2", {{"field", "max"}}},
                           {"color", vega::line_color("stage", stage_names())}}}}});
  };
  const vega::Choice stage = vega::choice_of("stage", "Signal", "all", stage_names());
  section.blocks.push_back(Figure{
      id, "Signals of " + record.dataset + " before and after the filter (" + record.label + ")", caption,
      vega::specification(caption, vega::csv_data(id, {"c", "row", "min", "max"}), {stage},
                          {{"transform", {vega::filter("stage == 'all' || datum.stage == stage")}},
                           {"vconcat", signal_panels(panel)}})});
}

void add_detail(const RunRecord& record, const std::string& prefix, Section& section, Document& document) {
  std::string csv = "c,stage,row,value\n";
  std::size_t rows = 0;
  for (std::size_t c = 0; c < kSignals.size(); ++c)
    for (const std::string& stage : stage_names())
      if (const std::vector<double>* values =
              series_of(record, fmt::format("detail.{}.{}", kSignals[c].id, stage))) {
        rows = std::max(rows, values->size());
        for (std::size_t k = 0; k < values->size(); ++k)
          fmt::format_to(std::back_inserter(csv), "{},{},{},{:.6g}\n", c, stage, k, (*values)[k]);
      }
  const std::vector<double>* width = series_of(record, "signal.width");
  if (rows == 0 || (width != nullptr && width->front() == 1)) return;  // the whole run shows them already
  const std::string id = prefix + "detail";
  document.datasets[id] = csv;
  const std::string caption = fmt::format("The first {} rows as they are.", rows);
  const auto panel = [](const NoiseChannel& signal, const std::string& x_title) {
    return json::array({{{"mark", {{"type", "line"}}},
                         {"encoding",
                          {{"x", vega::quantitative("row", x_title)},
                           {"y", vega::quantitative("value", panel_title(signal))},
                           {"color", vega::line_color("stage", stage_names())}}}}});
  };
  const vega::Choice stage = vega::choice_of("stage", "Signal", "all", stage_names());
  section.blocks.push_back(
      Figure{id, "First rows of " + record.dataset + " (" + record.label + ")", caption,
             vega::specification(caption, vega::csv_data(id, {"c", "row", "value"}), {stage},
                                 {{"transform", {vega::filter("stage == 'all' || datum.stage == stage")}},
                                  {"vconcat", signal_panels(panel)}})});
}

// Counts per label, as a share of its windows.
void add_gap_histogram(const std::map<std::string, std::vector<double>>& counts, const std::string& id,
                       const std::string& title, Section& section, Document& document) {
  std::size_t last = 0;
  std::vector<std::string> labels, bins;
  for (const auto& [label, list] : counts) {
    labels.push_back(label);
    for (std::size_t b = 0; b < list.size(); ++b)
      if (list[b] > 0) last = std::max(last, b);
  }
  std::size_t first = 1;  // the lowest bins are empty mostly
  const auto empty = [&](std::size_t b) {
    return std::all_of(counts.begin(), counts.end(), [&](const auto& entry) { return entry.second[b] == 0; });
  };
  while (first < last && empty(first)) ++first;
  bins.push_back(gap_bin_name(0));
  for (std::size_t b = first; b <= last; ++b) bins.push_back(gap_bin_name(b));
  std::string csv = "label,bin,windows,share\n";
  for (const auto& [label, list] : counts) {
    double sum = 0;
    for (const double count : list) sum += count;
    for (std::size_t b = 0; b <= last; ++b)
      if (b == 0 || b >= first)
        fmt::format_to(std::back_inserter(csv), "{},{},{:.0f},{:.6g}\n", csv_field(label), gap_bin_name(b),
                       list[b], 100 * list[b] / sum);
  }
  document.datasets[id] = csv;
  const std::string caption =
      "Share of the windows by how far H is below the best on the lattice; 0: the optimum was found.";
  json x{{"field", "bin"}, {"type", "ordinal"}, {"sort", bins}, {"title", "H of the optimum - H"}};
  section.blocks.push_back(
      Figure{id, title, caption,
             vega::specification(caption, vega::csv_data(id, {"windows", "share"}), {},
                                 {{"width", kFigureWidth},
                                  {"height", 280},
                                  {"mark", {{"type", "bar"}, {"tooltip", true}}},
                                  {"encoding",
                                   {{"x", x},
                                    {"xOffset", {{"field", "label"}, {"type", "nominal"}, {"sort", labels}}},
                                    {"y", vega::quantitative("share", "windows [%]")},
                                    {"color", vega::nominal("label", "", labels)}}}})});
}

}  // namespace

void add_filter_figures(const RunRecord& record, const std::string& prefix, Section& section,
                        Document& document) {
  add_bands(record, prefix, section, document);
  add_detail(record, prefix, section, document);
  const std::vector<double>* counts = series_of(record, "gap_counts");
  if (counts != nullptr && counts->size() == kGapBins)
    add_gap_histogram({{record.label, *counts}}, prefix + "gaps",
                      "Distance from the optimum (" + record.dataset + ")", section, document);
}

void add_window_figure(const std::vector<RunRecord>& records, const std::string& prefix, Section& section,
                       Document& document) {
  std::map<std::string, std::vector<double>> counts;
  for (const RunRecord& r : records) {
    const std::optional<double> exact = r.measures.value("hamiltonian_exact");
    const std::optional<double> found = r.measures.value("hamiltonian_rounded");
    if (!exact || !found) continue;
    const double gap = *exact - *found;
    if (!std::isfinite(gap)) continue;
    std::vector<double>& list = counts[r.label];
    list.resize(kGapBins);
    ++list[gap_bin(gap, *exact)];
  }
  if (counts.empty()) return;
  add_gap_histogram(counts, prefix + "window_gaps",
                    "Distance from the optimum, rounded to the lattice, by method", section, document);
}

}  // namespace odobench
