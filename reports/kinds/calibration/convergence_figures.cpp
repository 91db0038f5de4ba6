#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <set>

#include "reports/figures/vega.hpp"
#include "reports/kinds/calibration/run_figures.hpp"
#include "reports/statistics/statistics.hpp"

namespace odobench {
namespace {

using vega::json;

constexpr int kGridPoints = 90;
// What a logarithmic axis shows of a gap of zero.
constexpr double kSmallestGap = 1e-12;

constexpr const char* kCostTitle = "J, or J above the best";

using Effort = std::function<double(const TracePoint&)>;

std::vector<const ComparisonRow*> rows_with_traces(const Comparison& comparison) {
  std::vector<const ComparisonRow*> rows;
  for (const ComparisonRow& row : comparison.rows)
    if (row.kind == "run" &&
        std::any_of(row.runs.begin(), row.runs.end(), [](const RunRecord* r) { return !r->trace.empty(); }))
      rows.push_back(&row);
  return rows;
}

// Best J of a run when it had made `effort`; none before its first point.
std::optional<double> best_at(const RunRecord& run, const Effort& effort, double at) {
  std::optional<double> best;
  for (const TracePoint& point : run.trace) {
    if (effort(point) > at) break;
    if (std::isfinite(point.cost)) best = point.cost;
  }
  return best;
}

// From the first to the last trace point of any repeat, equal steps of the logarithm.
std::vector<double> grid_of(const ComparisonRow& row, const Effort& effort) {
  double first = INFINITY, last = 0;
  std::set<double> points;
  for (const RunRecord* run : row.runs)
    for (const TracePoint& p : run->trace) {
      if (!(effort(p) > 0)) continue;
      first = std::min(first, effort(p));
      last = std::max(last, effort(p));
      points.insert(effort(p));
    }
  if (points.size() <= kGridPoints) return {points.begin(), points.end()};
  std::vector<double> grid;
  for (int i = 0; i < kGridPoints; ++i)
    grid.push_back(first * std::pow(last / first, static_cast<double>(i) / (kGridPoints - 1)));
  grid.back() = last;  // rounding must not cut the last point off
  return grid;
}

struct CurveWriter {
  std::string csv = "q,s,n,min,q1,median,q3,max\n";

  void add(const char* quantity, std::size_t series, double at, std::vector<double> values, double floor) {
    for (double& v : values) v = std::max(v, floor);
    const Spread s = spread(std::move(values));
    if (!(s.min > 0)) return;  // a logarithmic axis has no place for it
    fmt::format_to(std::back_inserter(csv), "{},{},{:.6g},{:.8g},{:.8g},{:.8g},{:.8g},{:.8g}\n", quantity,
                   series, at, s.min, s.lower_quartile, s.median, s.upper_quartile, s.max);
  }
};

std::string curves(const std::vector<const ComparisonRow*>& rows, const Effort& effort, double best) {
  CurveWriter writer;
  for (std::size_t s = 0; s < rows.size(); ++s)
    for (const double at : grid_of(*rows[s], effort)) {
      std::vector<double> costs, gaps;
      for (const RunRecord* run : rows[s]->runs)
        if (const std::optional<double> cost = best_at(*run, effort, at)) {
          costs.push_back(*cost);
          gaps.push_back(*cost - best);
        }
      // A band of some repeats would jump when the others begin.
      if (costs.size() < rows[s]->runs.size()) continue;
      writer.add("cost", s, at, costs, 0);
      writer.add("gap", s, at, gaps, kSmallestGap * (best != 0 ? std::abs(best) : 1));
    }
  return writer.csv;
}

json convergence_spec(const std::string& data, const std::string& caption, const std::string& effort,
                      const std::vector<std::string>& labels, bool bands) {
  const vega::Choice quantity{"quantity", "Show", {{"gap", "J above the best"}, {"cost", "J"}}, "gap"};
  vega::Choice method = vega::choice_of("method", "Method", "all methods", labels);
  json x = vega::logarithmic("n", effort);
  const json color = vega::line_color("label", labels);
  const auto area = [&](const char* low, const char* high, double opacity) {
    json y = vega::logarithmic(low, kCostTitle);
    return json{
        {"mark", {{"type", "area"}, {"interpolate", "step-after"}, {"opacity", 1}, {"fillOpacity", opacity}}},
        {"encoding", {{"x", x}, {"y", y}, {"y2", {{"field", high}}}, {"color", color}}}};
  };
  json layer = json::array();
  if (bands) {
    layer.push_back(area("min", "max", 0.14));
    layer.push_back(area("q1", "q3", 0.28));
  }
  json y = vega::logarithmic("median", kCostTitle);
  layer.push_back({{"mark", {{"type", "line"}, {"interpolate", "step-after"}}},
                   {"encoding", {{"x", x}, {"y", y}, {"color", color}}}});
  return vega::specification(caption, vega::csv_data(data, {"s", "n", "min", "q1", "median", "q3", "max"}),
                             {quantity, method},
                             {{"width", kFigureWidth},
                              {"height", 360},
                              {"transform",
                               {vega::name_of("s", labels, "label"), vega::filter("datum.q == quantity"),
                                vega::filter("method == 'all' || datum.label == method")}},
                              {"layer", layer}});
}

}  // namespace

void add_convergence_figures(const Comparison& comparison, const std::string& prefix, Section& section,
                             Document& document) {
  const std::vector<const ComparisonRow*> rows = rows_with_traces(comparison);
  const std::optional<double> best = comparison.best_cost();
  if (rows.empty() || !best) return;
  std::vector<std::string> labels;
  bool bands = false;
  for (const ComparisonRow* row : rows) {
    labels.push_back(row->label);
    bands = bands || row->runs.size() > 1;
  }
  const std::string what =
      fmt::format("Best J so far{}, J above the best of all runs ({:.10g}) cut at {:g} of it.",
                  bands ? ", median over the repeats with quartiles (dark) and extremes (light)" : "", *best,
                  kSmallestGap);
  const auto add = [&](const std::string& kind, const std::string& title, const std::string& effort_name,
                       const Effort& effort) {
    const std::string id = prefix + "convergence." + kind;
    document.datasets[id] = curves(rows, effort, *best);
    section.blocks.push_back(Figure{id, title + comparison.title_suffix, what,
                                    convergence_spec(id, what, effort_name, labels, bands)});
  };
  add("evaluations", "Convergence over evaluations", "evaluations",
      [](const TracePoint& p) { return static_cast<double>(p.evaluations); });
  add("seconds", "Convergence over time", "time [s]", [](const TracePoint& p) { return p.seconds; });
}

void add_repeat_figure(const Comparison& comparison, const std::string& prefix, Section& section,
                       Document& document) {
  std::vector<std::string> labels;
  std::string csv = "label,repetition,cost,evaluations,seconds\n";
  bool several = false;
  for (const ComparisonRow& row : comparison.rows) {
    if (row.kind != "run") continue;
    labels.push_back(row.label);
    several = several || row.runs.size() > 1;
    for (const RunRecord* run : row.runs)
      if (run->cost)
        fmt::format_to(std::back_inserter(csv), "{},{},{:.12g},{},{:.6g}\n", csv_field(row.label),
                       run->repetition, *run->cost, run->evaluations, run->seconds);
  }
  if (!several) return;
  const std::string id = prefix + "repeats";
  const std::string caption = "Each run by its effort and its final J: down and to the left is better.";
  document.datasets[id] = csv;
  json tooltip = json::array();
  for (const char* field : {"label", "repetition", "cost", "evaluations", "seconds"})
    tooltip.push_back({{"field", field}, {"type", "nominal"}});
  const vega::Choice effort{
      "effort", "Effort", {{"evaluations", "evaluations"}, {"seconds", "seconds"}}, "evaluations"};
  section.blocks.push_back(Figure{
      id, "Final J of every repeat" + comparison.title_suffix, caption,
      vega::specification(caption, vega::csv_data(id, {"repetition", "cost", "evaluations", "seconds"}),
                          {effort},
                          {{"width", kFigureWidth},
                           {"height", 320},
                           {"transform", {{{"calculate", "datum[effort]"}, {"as", "effort_made"}}}},
                           {"mark", {{"type", "point"}}},
                           {"encoding",
                            {{"x", vega::logarithmic("effort_made", "evaluations, or seconds")},
                             {"y", vega::quantitative("cost", "final J")},
                             {"color", vega::nominal("label", "", labels)},
                             {"shape", vega::nominal("label", "", labels)},
                             {"tooltip", tooltip}}}})});
}

}  // namespace odobench
