#include "reports/kinds/calibration/card_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <span>
#include <vector>

#include "base/angle.hpp"
#include "base/range.hpp"
#include "reports/figures/decimate.hpp"
#include "reports/figures/vega.hpp"
#include "reports/kinds/calibration/overview_tables.hpp"
#include "reports/kinds/calibration/run_figures.hpp"
#include "reports/kinds/calibration/table_parts.hpp"
#include "reports/statistics/statistics.hpp"

namespace odobench {
namespace {

using vega::json;

constexpr double kPanel = 190;       // px
constexpr double kResolution = 500;  // parts of a panel's range that thinning respects

// A drive, and how far the two paths are from motion capture.
struct Drive {
  const TrackRecording* recording = nullptr;
  double before = 0, after = 0;  // RMS, m
};

const PoseTrack* track_of(const TrackSet& set, const std::string& label) {
  for (const StoredTrack& track : set.tracks)
    if (track.label == label) return &track.pose;
  return nullptr;
}

double rms_distance(const PoseTrack& a, const PoseTrack& b, const TrackRecording& r) {
  double sum = 0, count = 0;
  for (std::size_t k = r.begin; k < r.begin + r.samples; ++k) {
    const double d = std::hypot(a.x[k] - b.x[k], a.y[k] - b.y[k]);
    if (!std::isfinite(d)) continue;
    sum += d * d;
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : kNotANumber;
}

struct Shown {
  const TrackSet* set = nullptr;
  const PoseTrack *nominal = nullptr, *best = nullptr;
  Drive most, least;
};

std::optional<Shown> drives_to_show(const Comparison& comparison, const std::string& label,
                                    const std::vector<PlacedTracks>& tracks) {
  for (const PlacedTracks& placed : tracks) {
    Shown shown{placed.set, track_of(*placed.set, "nominal"), track_of(*placed.set, label), {}, {}};
    if (placed.set->problem != comparison.problem || placed.set->dataset != comparison.dataset ||
        shown.nominal == nullptr || shown.best == nullptr)
      continue;
    for (const TrackRecording& r : shown.set->recordings) {
      const Drive drive{&r, rms_distance(*shown.nominal, shown.set->reference, r),
                        rms_distance(*shown.best, shown.set->reference, r)};
      const double gain = drive.before - drive.after;
      if (!std::isfinite(gain)) continue;
      if (shown.most.recording == nullptr || gain > shown.most.before - shown.most.after) shown.most = drive;
      if (shown.least.recording == nullptr || gain < shown.least.before - shown.least.after)
        shown.least = drive;
    }
    if (shown.most.recording != nullptr) return shown;
  }
  return std::nullopt;
}

// A square around all paths of a panel.
struct Square {
  double x = 0, y = 0, half = 0;
  std::array<double, 2> across() const { return {x - half, x + half}; }
  std::array<double, 2> up() const { return {y - half, y + half}; }
};

Square square_of(const std::vector<const PoseTrack*>& paths, const TrackRecording& r) {
  double x0 = kInfinity, x1 = -kInfinity, y0 = kInfinity, y1 = -kInfinity;
  for (const PoseTrack* path : paths)
    for (std::size_t k = r.begin; k < r.begin + r.samples; ++k) {
      if (!std::isfinite(path->x[k]) || !std::isfinite(path->y[k])) continue;
      x0 = std::min(x0, path->x[k]), x1 = std::max(x1, path->x[k]);
      y0 = std::min(y0, path->y[k]), y1 = std::max(y1, path->y[k]);
    }
  const double half = 0.54 * std::max({x1 - x0, y1 - y0, 1e-3});
  return {(x0 + x1) / 2, (y0 + y1) / 2, half};
}

void append_paths(std::string& csv, const std::vector<const PoseTrack*>& paths, const Shown& shown,
                  const TrackRecording& r, int panel, double range) {
  const auto part = [&](const std::vector<double>& v) { return std::span(v).subspan(r.begin, r.samples); };
  for (std::size_t s = 0; s < paths.size(); ++s) {
    const auto x = part(paths[s]->x), y = part(paths[s]->y), t = part(shown.set->time_s);
    for (const std::size_t k : decimate(t, {{x, range / kResolution}, {y, range / kResolution}}))
      fmt::format_to(std::back_inserter(csv), "{},{},{:.6g},{:.6g},{:.6g}\n", panel, s, t[k], x[k], y[k]);
  }
}

json path_view(const Drive& drive, const Square& square, int panel, const std::vector<std::string>& names) {
  json x = vega::quantitative("x", "x [m]"), y = vega::quantitative("y", "y [m]");
  x["scale"] = {{"domain", square.across()}, {"nice", false}};
  y["scale"] = {{"domain", square.up()}, {"nice", false}};
  x["axis"] = y["axis"] = {{"tickCount", 4}};
  const std::string change = fmt::format("{:.1f} to {:.1f} mm RMS", 1000 * drive.before, 1000 * drive.after);
  return {
      {"width", kPanel},
      {"height", kPanel},
      {"title", {{"text", drive.recording->id}, {"subtitle", change}}},
      {"transform", {vega::filter(fmt::format("datum.p == {}", panel)), vega::name_of("s", names, "label")}},
      {"mark", {{"type", "line"}}},
      {"encoding",
       {{"x", x},
        {"y", y},
        {"order", {{"field", "t"}, {"type", "quantitative"}}},
        {"color", vega::line_color("label", names)}}}};
}

// Deviations from nominal in %. False without a free parameter.
bool write_parameters(const RunRecord& record, const std::string& label, std::string& csv) {
  csv = "label,parameter,value,low,high,lower,upper\n";
  bool any = false;
  for (const ParameterValue& p : record.parameters) {
    if (p.lower >= p.upper) continue;
    const auto percent = [&](double v) { return 100 * (v - p.nominal) / deviation_scale(p); };
    const double half = 100 * relative_half_width(record, p).value_or(0);
    fmt::format_to(std::back_inserter(csv), "{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", csv_field(label),
                   csv_field(p.name), percent(p.value), percent(p.value) - half, percent(p.value) + half,
                   percent(p.lower), percent(p.upper));
    any = true;
  }
  return any;
}

json parameter_view(const std::string& data, const RunRecord& record,
                    const std::vector<std::string>& labels) {
  std::vector<std::string> names;
  for (const ParameterValue& p : record.parameters)
    if (p.lower < p.upper) names.push_back(p.name);
  const json y{{"field", "parameter"},
               {"type", "nominal"},
               {"sort", names},
               {"title", nullptr},
               {"axis", {{"labelFontSize", names.size() > 14 ? 9 : 11}}}};
  const auto layer = [&](const char* from, const char* to, json mark) {
    json x = vega::quantitative(from, "off nominal [%]");
    json encoding{{"x", x}, {"y", y}};
    if (to != nullptr) encoding["x2"] = {{"field", to}};
    return json{{"mark", std::move(mark)}, {"encoding", encoding}};
  };
  json box =
      layer("lower", "upper", {{"type", "rule"}, {"style", "muted"}, {"strokeWidth", 5}, {"opacity", 0.25}});
  json interval = layer("low", "high", {{"type", "rule"}, {"strokeWidth", 1.5}});
  json value = layer("value", nullptr, {{"type", "point"}, {"filled", true}, {"size", 40}});
  for (json* l : {&interval, &value}) (*l)["encoding"]["color"] = vega::line_color("label", labels);
  return {{"width", kPanel},
          {"height", kPanel},
          {"title", {{"text", "Parameters"}, {"subtitle", "band: box, line: 95 % interval"}}},
          {"data", vega::csv_data(data, {"value", "low", "high", "lower", "upper"})},
          {"layer", json::array({box, interval, value})}};
}

}  // namespace

std::string change_words(const Comparison& comparison) {
  const BestRun best = best_run(comparison);
  const ComparisonRow* nominal = comparison.nominal();
  if (best.row == nullptr || nominal == nullptr || nominal->errors.empty() ||
      best.row->errors.size() != nominal->errors.size())
    return "";
  const Totals after = error_totals(best.row->errors), before = error_totals(nominal->errors);
  const auto n = static_cast<double>(nominal->errors.size());
  const auto digits = [](double a, double b) { return std::min(a, b) < 1 ? 2 : std::min(a, b) < 10 ? 1 : 0; };
  const auto words = [&](const char* name, double from, double to, double unit, const char* read) {
    const int d = digits(from / n * unit, to / n * unit);
    return fmt::format("{} {:.{}f} to {:.{}f} {}", name, from / n * unit, d, to / n * unit, d, read);
  };
  const WorseMeans worse = worse_means(*best.row, *nominal);
  return fmt::format(
      "{}, {}, {}; {} of {} mean errors got worse.", words("x", before.sums[0], after.sums[0], 1000, "mm"),
      words("y", before.sums[1], after.sums[1], 1000, "mm"),
      words("heading", before.sums[2], after.sums[2], 1 / kDegree, "deg"), worse.worse, worse.all);
}

void add_card_figure(const Comparison& comparison, const std::vector<PlacedTracks>& tracks,
                     const std::string& prefix, Section& section, Document& document) {
  const BestRun best = best_run(comparison);
  if (best.row == nullptr || comparison.nominal() == nullptr || best.record->errors.empty()) return;
  json views = json::array();
  const std::string path_data = prefix + "card.paths", parameter_data = prefix + "card.parameters";
  const std::vector<std::string> names{vega::kReferenceLabel, "nominal", best.row->label};
  std::string caption;
  if (const std::optional<Shown> shown = drives_to_show(comparison, best.row->label, tracks)) {
    const std::vector<const PoseTrack*> paths{&shown->set->reference, shown->nominal, shown->best};
    std::string csv = "p,s,t,x,y\n";
    int panel = 0;
    for (const Drive* drive : {&shown->most, &shown->least}) {
      if (panel == 1 && drive->recording == shown->most.recording) break;
      const Square square = square_of(paths, *drive->recording);
      append_paths(csv, paths, *shown, *drive->recording, panel, 2 * square.half);
      views.push_back(path_view(*drive, square, panel, names));
      views.back()["data"] = vega::csv_data(path_data, {"p", "s", "t", "x", "y"});
      ++panel;
    }
    document.datasets[path_data] = csv;
    caption = panel == 2 ? "The drive that the calibration improved most and the one that it improved least. "
                         : "The drive of the set. ";
  }
  if (std::string csv; write_parameters(*best.record, best.row->label, csv)) {
    document.datasets[parameter_data] = csv;
    views.push_back(parameter_view(parameter_data, *best.record, names));
  }
  if (views.empty()) return;
  const std::string words = change_words(comparison);
  caption += words.empty() ? "" : "Mean errors: " + words;
  const json data = views.front()["data"];
  views.front().erase("data");
  json spec{{"$schema", "https://vega.github.io/schema/vega-lite/v6.json"},
            {"description", caption},
            {"data", data},
            {"usermeta", {{"odobench", {{"columns", 3}, {"aspect", "equal"}}}}},
            {"hconcat", views}};
  section.blocks.emplace_back(Figure{
      prefix + "card", "Before and after: " + best.row->label + comparison.title_suffix, caption, spec});
}

}  // namespace odobench
