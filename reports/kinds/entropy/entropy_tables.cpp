#include "reports/kinds/entropy/entropy_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace odobench {
namespace {

std::optional<double> figure(const RunRecord& record, const std::string& name) {
  const std::optional<double> value = record.measures.value(name);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

Cell figure_cell(const std::optional<double>& value, int digits) {
  return value ? significant_cell(*value, digits) : Cell{};
}
Cell whole_cell(const std::optional<double>& value) {
  return value ? count_cell(*value) : Cell{};
}
Cell factor_cell(const std::optional<double>& before, const std::optional<double>& after) {
  return before && after && *after > 0 ? fixed_cell(*before / *after, 2) : Cell{};
}

Table method_table(const std::vector<RunRecord>& records) {
  Table table{"filter", "Relative-entropy filter", {}, {}, {}};
  table.columns = {
      {"data", "data", "", "", "", Align::Left},
      {"method", "method", "", "", "", Align::Left},
      {"rows", "rows", "", "", "size"},
      {"windows", "windows", "", "", "size"},
      {"iterations_mean", "iterations, mean", "", "", "search"},
      {"iterations_max", "max", "", "", "search"},
      best_if(Better::Lower, {"evaluations_mean", "evaluations, mean", "", "", "search"}),
      {"hamiltonian_mean", "H, mean", "", "", "hamiltonian"},
      {"hamiltonian_min", "min", "", "", "hamiltonian"},
      {"hamiltonian_max", "max", "", "", "hamiltonian"},
      {"gain_mean", "above zero increments, mean", "", "", "gain"},
      {"gain_max", "max", "", "", "gain"},
      best_if(Better::Lower, {"gap_exact_mean", "below the optimum, mean", "", "", "gap"}),
      best_if(Better::Lower, {"gap_exact_max", "max", "", "", "gap"}),
      best_if(Better::Higher, {"at_optimum", "at it", "%", "", "gap"}),
      best_if(Better::Lower, {"gap_relaxed_mean", "below the relaxation, mean", "", "", "relaxation"}),
      best_if(Better::Lower, {"gap_relaxed_max", "max", "", "", "relaxation"}),
      {"seconds", "time", "s", "", "speed"},
      {"windows_per_second", "windows/s", "", "", "speed"}};
  bool gaps = false;
  for (const RunRecord& r : records) {
    const auto at_optimum = figure(r, "at_optimum");
    gaps = gaps || at_optimum;
    std::vector<Cell> cells{text_cell(r.dataset), text_cell(r.label), whole_cell(figure(r, "rows")),
                            whole_cell(figure(r, "windows"))};
    cells.push_back(figure_cell(figure(r, "iterations_mean"), 4));
    cells.push_back(whole_cell(figure(r, "iterations_max")));
    cells.push_back(figure_cell(figure(r, "evaluations_mean"), 5));
    for (const char* name : {"hamiltonian_mean", "hamiltonian_min", "hamiltonian_max"})
      cells.push_back(figure_cell(figure(r, name), 8));
    for (const char* name : {"gain_mean", "gain_max", "gap_exact_mean", "gap_exact_max"})
      cells.push_back(figure_cell(figure(r, name), 4));
    cells.push_back(at_optimum ? fixed_cell(100 * *at_optimum, 1) : Cell{});
    for (const char* name : {"gap_relaxed_mean", "gap_relaxed_max"})
      cells.push_back(figure_cell(figure(r, name), 4));
    cells.push_back(fixed_cell(r.seconds, 3));
    cells.push_back(whole_cell(figure(r, "windows_per_second")));
    table.rows.push_back(std::move(cells));
  }
  for (const RunRecord& r : records)
    for (const std::string& note : r.notes) table.notes.push_back(r.label + ": " + note);
  if (gaps)
    table.notes.push_back(
        fmt::format("At the optimum: H within {:g} |H| of the best of all t in {{-1, 0, 1}}. The relaxation "
                    "lets t be any "
                    "number in [-1, 1].",
                    kSameOptimum));
  return table;
}

std::string suffix(const RunRecord& record) {
  return record.label + (record.dataset.empty() ? "" : ", " + record.dataset);
}

std::optional<Table> noise_table(const RunRecord& record) {
  Table table{
      "noise." + record.label, "Errors before and after the filter (" + suffix(record) + ")", {}, {}, {}};
  table.columns = {{"channel", "channel", "", "", "", Align::Left},
                   {"measure", "error", "", "", "", Align::Left},
                   {"before", "before", "", "", ""},
                   {"after", "after", "", "", "after"},
                   {"factor", "factor", "", "", "after"},
                   {"zero", "zero increments", "", "", "zero"},
                   {"zero_factor", "factor", "", "", "zero"}};
  const bool compared = figure(record, "cpu.kalman").has_value();
  if (compared)
    for (const auto& [id, name] : {std::pair{"kalman", "Kalman filter"}, {"smoother", "Kalman smoother"}}) {
      table.columns.push_back({id, name, "", "", id});
      table.columns.push_back({std::string(id) + "_factor", "factor", "", "", id});
    }
  for (const NoiseChannel& channel : kNoiseChannels)
    for (const std::string measure : kNoiseMeasures) {
      const std::string name = fmt::format("noise.{}.{}.", channel.id, measure);
      const auto before = figure(record, name + "before"), after = figure(record, name + "after"),
                 zero = figure(record, name + "zero");
      if (!before) continue;
      const std::string shown = measure == "ratio"
                                    ? "mean / mean |truth|"
                                    : fmt::format("{} [{}]", measure == "rms" ? "RMS" : "max", channel.unit);
      table.rows.push_back({text_cell(channel.name), text_cell(shown), figure_cell(before, 4),
                            figure_cell(after, 4), factor_cell(before, after), figure_cell(zero, 4),
                            factor_cell(before, zero)});
      if (!compared) continue;
      for (const char* stage : kComparedStages) {
        const auto value = figure(record, name + stage);
        table.rows.back().push_back(figure_cell(value, 4));
        table.rows.back().push_back(factor_cell(before, value));
      }
    }
  if (table.rows.empty()) return std::nullopt;
  if (compared) {
    const auto cpu = [&](const char* stage) {
      return figure_cell(figure(record, std::string("cpu.") + stage), 3);
    };
    table.rows.push_back({text_cell("all"), text_cell("processor time [us/sample]"), Cell{}, cpu("after"),
                          Cell{}, Cell{}, Cell{}, cpu("kalman"), Cell{}, cpu("smoother"), Cell{}});
  }
  table.notes = {
      "Zero increments: the same filter without any search, the control.",
      "Encoders, x and y: components of all wheels in the filter's frame. ax, ay after the filter: "
      "ax12, ay12 against the mean of the two true samples they lie between."};
  if (compared)
    table.notes.push_back(
        "Kalman: the linear model of a window with the same deviations, increments white with sqrt(2/3) of "
        "their size. The filter says a sample when it comes, the smoother as many samples late as the "
        "relative-entropy filter.");
  return table;
}

std::optional<Table> track_table(const RunRecord& record) {
  Table table{"tracks." + record.label,
              "Dead reckoning, distance from the true path (" + suffix(record) + ")",
              {},
              {},
              {}};
  table.columns = {{"from", "from", "", "", "", Align::Left},
                   best_if(Better::Lower, {"end", "at the end", "m", "", ""}),
                   best_if(Better::Lower, {"max", "at most", "m", "", ""})};
  const std::array<std::pair<const char*, const char*>, 5> stages{{{kNoiseStages[0], "measurements"},
                                                                   {kNoiseStages[1], "filter"},
                                                                   {kNoiseStages[2], "zero increments"},
                                                                   {kComparedStages[0], "Kalman filter"},
                                                                   {kComparedStages[1], "Kalman smoother"}}};
  for (const auto& [stage, name] : stages) {
    const auto end = figure(record, std::string("track.end.") + stage);
    if (!end) continue;
    table.rows.push_back({text_cell(name), significant_cell(*end, 4),
                          figure_cell(figure(record, std::string("track.max.") + stage), 4)});
  }
  if (table.rows.empty()) return std::nullopt;
  return table;
}

}  // namespace

std::size_t gap_bin(double gap, double hamiltonian_exact) {
  if (gap <= kSameOptimum * std::abs(hamiltonian_exact)) return 0;
  const double place = std::floor(2 * std::log10(std::max(gap, kGapLowest) / kGapLowest));
  return 1 + std::min(kGapBins - 2, static_cast<std::size_t>(place));
}

std::string gap_bin_name(std::size_t bin) {
  if (bin == 0) return "0";
  const auto edge = [](std::size_t k) { return kGapLowest * std::pow(10, static_cast<double>(k) / 2); };
  const auto text = [&](double v) { return v < 10 ? fmt::format("{:.2g}", v) : fmt::format("{:.0f}", v); };
  return text(edge(bin - 1)) + " .. " + text(edge(bin));
}

std::vector<Table> filter_tables(const std::vector<RunRecord>& records) {
  if (records.empty()) return {};
  std::vector<Table> tables;
  for (const RunRecord& record : records) {
    if (auto table = noise_table(record)) tables.push_back(std::move(*table));
    if (auto table = track_table(record)) tables.push_back(std::move(*table));
  }
  tables.push_back(method_table(records));
  return tables;
}

}  // namespace odobench
