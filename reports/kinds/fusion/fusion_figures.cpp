#include "reports/kinds/fusion/fusion_figures.hpp"

#include <fmt/format.h>

#include <iterator>

#include "reports/figures/vega.hpp"

namespace odobench {
namespace {

using vega::json;

// nees: one row per label and instant, s the place of the label.
Figure nees_figure(const std::string& nees_id, const std::vector<std::string>& labels) {
  const std::string nees_caption =
      "Normalised estimation error squared of the pose, mean over the recordings at each instant; grey: the "
      "95 % band of a "
      "filter whose covariance is right (3 is expected). Above it the filter is over-confident.";
  const json x = vega::quantitative("percent", "part of the drive [%]");
  json band{
      {"transform", {vega::filter("datum.s == 0")}},
      {"mark", {{"type", "area"}, {"style", "reference_band"}}},
      {"encoding", {{"x", x}, {"y", vega::logarithmic("lower", "NEES")}, {"y2", {{"field", "upper"}}}}}};
  json lines{
      {"transform", {vega::filter("method == 'all' || datum.label == method")}},
      {"mark", {{"type", "line"}}},
      {"encoding",
       {{"x", x}, {"y", vega::logarithmic("nees", "NEES")}, {"color", vega::line_color("label", labels)}}}};
  return Figure{
      nees_id, "Consistency over the drive (NEES)", nees_caption,
      vega::specification(nees_caption, vega::csv_data(nees_id, {"s", "percent", "nees", "lower", "upper"}),
                          {vega::choice_of("method", "Method", "all methods", labels)},
                          {{"width", kFigureWidth},
                           {"height", 320},
                           {"transform", {vega::name_of("s", labels, "label")}},
                           {"layer", json::array({band, lines})}})};
}

// nis: one row per label and sensor.
Figure nis_figure(const std::string& nis_id, const std::vector<std::string>& labels) {
  const std::string nis_caption =
      "Normalised innovation squared of every sensor over its degrees of freedom (1 is expected); bars: the "
      "95 % band of its "
      "mean.";
  const json y{{"field", "label"}, {"type", "nominal"}, {"sort", labels}, {"title", nullptr}};
  const json offset{{"field", "sensor"}, {"type", "nominal"}};
  json low = vega::logarithmic("lower", "NIS / degrees of freedom");
  json bar{
      {"mark", {{"type", "rule"}, {"style", "reference"}, {"strokeWidth", 4}, {"strokeDash", json::array()}}},
      {"encoding", {{"x", low}, {"x2", {{"field", "upper"}}}, {"y", y}, {"yOffset", offset}}}};
  json point{{"mark", {{"type", "point"}, {"filled", true}, {"size", 60}, {"tooltip", true}}},
             {"encoding",
              {{"x", vega::logarithmic("nis", "NIS / degrees of freedom")},
               {"y", y},
               {"yOffset", offset},
               {"color", {{"field", "sensor"}, {"type", "nominal"}, {"title", nullptr}}},
               {"shape", {{"field", "sensor"}, {"type", "nominal"}, {"title", nullptr}}}}}};
  return Figure{nis_id, "Innovations of the sensors (NIS)", nis_caption,
                vega::specification(nis_caption, vega::csv_data(nis_id, {"nis", "lower", "upper"}), {},
                                    {{"width", kFigureWidth},
                                     {"height", 40 * static_cast<double>(labels.size())},
                                     {"layer", json::array({bar, point})}})};
}

}  // namespace

void add_consistency_figures(const std::vector<FusionRow>& rows, const std::string& prefix, Section& section,
                             Document& document) {
  std::vector<std::string> labels;
  std::string nees = "s,percent,nees,lower,upper\n", nis = "label,sensor,nis,lower,upper\n";
  bool sensors = false;
  for (const FusionRow& row : rows) {
    if (row.nees.empty()) continue;
    for (std::size_t g = 0; g < row.nees.size(); ++g)
      fmt::format_to(std::back_inserter(nees), "{},{:.4g},{:.6g},{:.6g},{:.6g}\n", labels.size(),
                     100 * static_cast<double>(g + 1) / static_cast<double>(row.nees.size()), row.nees[g],
                     row.lower, row.upper);
    labels.push_back(row.label);
    for (const FusionSensorRow& s : row.sensors) {
      if (s.dof < 1) continue;
      sensors = true;
      const double dof = s.dof;
      fmt::format_to(std::back_inserter(nis), "{},{},{:.6g},{:.6g},{:.6g}\n", csv_field(row.label),
                     csv_field(s.name), s.mean_nis / dof, s.lower / dof, s.upper / dof);
    }
  }
  if (labels.empty()) return;
  document.datasets[prefix + "nees"] = nees;
  section.blocks.push_back(nees_figure(prefix + "nees", labels));
  if (!sensors) return;
  document.datasets[prefix + "nis"] = nis;
  section.blocks.push_back(nis_figure(prefix + "nis", labels));
}

}  // namespace odobench
