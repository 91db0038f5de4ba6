#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

#include "reports/figures/vega.hpp"
#include "reports/kinds/optimisers/optimiser_scores.hpp"
#include "reports/kinds/optimisers/optimiser_tables.hpp"
#include "reports/statistics/optimisers/runtimes.hpp"

namespace odobench {
namespace {

using vega::json;

// Steps closer than this to the one before are not drawn.
constexpr double kVisible = 1e-3;

// Rows "group,s,x,y" of a curve, from zero at its first step to a last one at `end`.
void add_curve(std::string& csv, const std::string& group, std::size_t solver, const StepCurve& curve,
               double end) {
  double drawn = 0;
  if (!curve.empty() && curve.front().first > 0)
    fmt::format_to(std::back_inserter(csv), "{},{},{:.6g},0\n", group, solver, curve.front().first);
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const auto& [x, y] = curve[i];
    if (!(x > 0) || (i + 1 < curve.size() && y - drawn < kVisible)) continue;
    fmt::format_to(std::back_inserter(csv), "{},{},{:.6g},{:.6g}\n", group, solver, x, y);
    drawn = y;
  }
  if (!curve.empty() && curve.back().first < end)
    fmt::format_to(std::back_inserter(csv), "{},{},{:.6g},{:.6g}\n", group, solver, end, curve.back().second);
}

// A little behind the last step of all, so that it is seen.
double last_step(const std::vector<StepCurve>& curves) {
  double end = 1;
  for (const StepCurve& curve : curves)
    if (!curve.empty()) end = std::max(end, curve.back().first);
  return 1.5 * end;
}

json curve_spec(const std::string& data, const std::string& caption, const std::vector<std::string>& solvers,
                const std::string& x_title, const std::string& y_title,
                const std::vector<vega::Choice>& choices) {
  json y = vega::quantitative("y", y_title);
  y["scale"] = {{"domain", {0, 1}}};
  json transform = json::array({vega::name_of("s", solvers, "label")});
  for (const vega::Choice& choice : choices)
    transform.push_back(vega::filter("datum.group == " + choice.parameter));
  return vega::specification(
      caption, vega::csv_data(data, {"s", "x", "y"}), choices,
      {{"width", kFigureWidth},
       {"height", 320},
       {"transform", transform},
       {"mark", {{"type", "line"}, {"interpolate", "step-after"}}},
       {"encoding",
        {{"x", vega::logarithmic("x", x_title)}, {"y", y}, {"color", vega::line_color("label", solvers)}}}});
}

void add_figure(const char* id, const char* title, const std::string& caption, std::string csv, json spec,
                Section& section, Document& document) {
  document.datasets[id] = std::move(csv);
  section.blocks.push_back(Figure{id, title, caption, std::move(spec)});
}

void add_distribution(const TrialTable& table, Section& section, Document& document) {
  std::vector<StepCurve> curves;
  for (std::size_t s = 0; s < table.solvers.size(); ++s) curves.push_back(runtime_distribution(table, s));
  std::string csv = "group,s,x,y\n";
  for (std::size_t s = 0; s < curves.size(); ++s) add_curve(csv, "all", s, curves[s], last_step(curves));
  const std::string caption =
      "Share of all problems and targets that a solver reaches within so many evaluations per dimension, "
      "with simulated "
      "restarts.";
  add_figure("ert.ecdf", "Runtime distribution (ECDF)", caption, std::move(csv),
             curve_spec("ert.ecdf", caption, table.solvers, "evaluations / dimension",
                        "share of problems and targets", {}),
             section, document);
}

using Profile = StepCurve (*)(const TrialTable&, std::size_t, double);

void add_profile(const char* id, const char* title, const std::string& caption, const std::string& x_title,
                 Profile profile, const TrialTable& table, Section& section, Document& document) {
  vega::Choice tau{"tau", "Gap", {}, fmt::format("g{}", kGaps.size() - 1)};
  std::string csv = "group,s,x,y\n";
  for (std::size_t k = 0; k < kGaps.size(); ++k) {
    const std::string group = fmt::format("g{}", k);
    tau.options.emplace_back(group, fmt::format("{:g}", kGaps[k]));
    std::vector<StepCurve> curves;
    for (std::size_t s = 0; s < table.solvers.size(); ++s) curves.push_back(profile(table, s, kGaps[k]));
    for (std::size_t s = 0; s < curves.size(); ++s) add_curve(csv, group, s, curves[s], last_step(curves));
  }
  add_figure(id, title, caption, std::move(csv),
             curve_spec(id, caption, table.solvers, x_title, "share of problems", {tau}), section, document);
}

// Solvers on a line by their mean rank; bars join those that cannot be told apart.
void add_critical_difference(const TrialTable& table, const RankScores& ranks, Section& section,
                             Document& document) {
  std::vector<std::size_t> order(table.solvers.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const std::vector<double>& mean = ranks.test.mean_ranks;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return mean[a] < mean[b]; });
  std::string csv = "kind,s,x,x2,y\n";
  double y = 0;
  for (const std::size_t s : order)
    fmt::format_to(std::back_inserter(csv), "solver,{},{:.6g},{:.6g},{}\n", s, mean[s], mean[s], y++);
  for (const RankBar& bar : rank_bars(mean, ranks.critical_difference))
    fmt::format_to(std::back_inserter(csv), "bar,0,{:.6g},{:.6g},{}\n", mean[order[bar.first]] - 0.04,
                   mean[order[bar.last]] + 0.04, y++);
  const std::string caption = fmt::format(
      "Mean ranks, lower is better. Bars join solvers whose mean ranks differ by less than Nemenyi's "
      "critical "
      "difference, {:.3g} at {:g}.",
      ranks.critical_difference, kAlpha);
  const json hidden = {{"field", "y"},
                       {"type", "quantitative"},
                       {"axis", nullptr},
                       {"scale", {{"domain", {-0.7, y - 0.3}}, {"reverse", true}}}};
  json x = vega::quantitative("x", "mean rank");
  x["scale"] = {{"domain", {1, table.solvers.size()}}};
  const json points = {{"transform", {vega::filter("datum.kind == 'solver'")}},
                       {"mark", {{"type", "point"}, {"filled", true}}},
                       {"encoding", {{"x", x}, {"y", hidden}}}};
  const json names = {
      {"transform", {vega::filter("datum.kind == 'solver'")}},
      {"mark", {{"type", "text"}, {"align", "left"}, {"dx", 8}}},
      {"encoding", {{"x", x}, {"y", hidden}, {"text", {{"field", "label"}, {"type", "nominal"}}}}}};
  const json bars = {{"transform", {vega::filter("datum.kind == 'bar'")}},
                     {"mark", {{"type", "rule"}, {"strokeWidth", 4}}},
                     {"encoding", {{"x", x}, {"x2", {{"field", "x2"}}}, {"y", hidden}}}};
  add_figure(
      "ranks.critical_difference", "Critical differences of mean ranks", caption, std::move(csv),
      vega::specification(caption, vega::csv_data("ranks.critical_difference", {"s", "x", "x2", "y"}), {},
                          {{"width", kFigureWidth},
                           {"height", std::max(120, 24 * static_cast<int>(y))},
                           {"transform", json::array({vega::name_of("s", table.solvers, "label")})},
                           {"layer", json::array({bars, points, names})}}),
      section, document);
}

}  // namespace

void add_optimiser_sections(const std::vector<RunRecord>& records, Document& document) {
  std::vector<Table> tables = optimiser_tables(records);
  if (tables.empty()) return;
  const TrialTable table = trial_table(records);
  Section ert{
      "ert", "Running times", "How many evaluations a solver needs to how small a gap, and how surely.", {}};
  add_distribution(table, ert, document);
  ert.blocks.emplace_back(std::move(tables[0]));
  Section profiles{
      "profiles", "Profiles", "Which share of the problems a solver solves with which effort.", {}};
  add_profile(
      "profiles.data", "Data profiles",
      "Share of problems solved within so many simplex gradients, n + 1 evaluations each (More and Wild).",
      "simplex gradients", data_profile, table, profiles, document);
  add_profile(
      "profiles.performance", "Performance profiles",
      "Share of problems solved within a multiple of the quickest solver's evaluations (Dolan and More).",
      "multiple of the quickest", performance_profile, table, profiles, document);
  profiles.blocks.emplace_back(std::move(tables[1]));
  Section ranks{"ranks", "Ranks", "Whether the solvers differ, over all problems, and which of them.", {}};
  add_critical_difference(table, rank_scores(table), ranks, document);
  ranks.blocks.emplace_back(std::move(tables[2]));
  ranks.blocks.emplace_back(std::move(tables[3]));
  for (Section* section : {&ert, &profiles, &ranks}) document.sections.push_back(std::move(*section));
}

}  // namespace odobench
