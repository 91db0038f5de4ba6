#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "reports/figures/vega.hpp"
#include "reports/kinds/calibration/run_figures.hpp"
#include "reports/records/series.hpp"

namespace odobench {
namespace {

using vega::json;

std::vector<const ParameterValue*> free_parameters(const RunRecord& record) {
  std::vector<const ParameterValue*> list;
  for (const ParameterValue& p : record.parameters)
    if (p.lower < p.upper) list.push_back(&p);
  return list;
}

// The run with the lowest J that says what its data determine.
const RunRecord* best_described(const Comparison& comparison) {
  const RunRecord* best = nullptr;
  for (const ComparisonRow& row : comparison.rows) {
    const RunRecord* shown = row.shown;
    if (!shown->cost || shown->series.count("singular_values") == 0) continue;
    if (best == nullptr || *shown->cost < *best->cost) best = shown;
  }
  return best;
}

// Of the plot, %: all bounds and values, and the bars unless they are far wider than the box.
double plot_edge(const Comparison& comparison) {
  double box = 0, interval = 0;
  for (const ComparisonRow& row : comparison.rows) {
    const std::vector<const ParameterValue*> parameters = free_parameters(*row.shown);
    for (const ParameterValue* free : parameters) {
      const ParameterValue& p = *free;
      const double value = std::abs(p.value - p.nominal) / deviation_scale(p);
      box = std::max({box, std::abs(p.upper - p.nominal) / deviation_scale(p),
                      std::abs(p.lower - p.nominal) / deviation_scale(p), value});
      if (const std::optional<double> half = relative_half_width(*row.shown, p))
        interval = std::max(interval, value + *half);
    }
  }
  return 100 * std::max(1.1 * box, std::min(1.02 * interval, 5 * box));
}

// Direction as text: its parts of at least a quarter of the largest, largest first.
std::string in_words(const std::vector<double>& directions, std::size_t column,
                     const std::vector<const ParameterValue*>& parameters) {
  const std::size_t n = parameters.size();
  std::vector<std::size_t> order(n);
  for (std::size_t i = 0; i < n; ++i) order[i] = i;
  const auto part = [&](std::size_t i) { return directions[column * n + i]; };
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return std::abs(part(a)) > std::abs(part(b)); });
  const double sign = part(order[0]) < 0 ? -1 : 1;
  std::string up, down;
  for (const std::size_t i : order) {
    if (std::abs(part(i)) < 0.25 * std::abs(part(order[0]))) break;
    std::string& list = sign * part(i) > 0 ? up : down;
    list += fmt::format("{}{} ({:.2f})", list.empty() ? "" : ", ", parameters[i]->name, std::abs(part(i)));
  }
  return "up: " + up + (down.empty() ? "" : "; down: " + down);
}

json parameter_spec(const std::string& data, const std::string& caption,
                    const std::vector<std::string>& names, const std::vector<std::string>& labels,
                    double edge) {
  json x = vega::quantitative("value", "deviation from nominal [%]");
  x["scale"] = {{"domain", {-edge, edge}}};
  const json y{{"field", "parameter"}, {"type", "nominal"}, {"sort", names}, {"title", nullptr}};
  const json offset{{"field", "label"}, {"type", "nominal"}, {"sort", labels}};
  const json color = vega::nominal("label", "", labels);
  const auto bound = [&](const char* field) {
    json at = x;
    at["field"] = field;
    return json{{"transform", {vega::filter("datum.first == 1")}},
                {"mark", {{"type", "tick"}, {"style", "reference"}, {"thickness", 2}}},
                {"encoding", {{"x", at}, {"y", y}}}};
  };
  json from = x;
  from["field"] = "low";
  json interval{
      {"mark", {{"type", "rule"}, {"clip", true}}},
      {"encoding",
       {{"x", from}, {"x2", {{"field", "high"}}}, {"y", y}, {"yOffset", offset}, {"color", color}}}};
  json points{{"mark", {{"type", "point"}, {"filled", true}, {"clip", true}, {"size", 36}}},
              {"encoding",
               {{"x", x},
                {"y", y},
                {"yOffset", offset},
                {"color", color},
                {"shape", vega::nominal("label", "", labels)},
                {"tooltip",
                 {{{"field", "label"}, {"type", "nominal"}},
                  {{"field", "parameter"}, {"type", "nominal"}},
                  {{"field", "value"}, {"type", "quantitative"}, {"title", "deviation [%]"}},
                  {{"field", "half_width"}, {"type", "nominal"}, {"title", "95 % interval, +- %"}}}}}}};
  const double height = static_cast<double>(names.size()) * (14.0 + 7.0 * static_cast<double>(labels.size()));
  return vega::specification(caption,
                             vega::csv_data(data, {"first", "value", "low", "high", "lower", "upper"}), {},
                             {{"width", kFigureWidth},
                              {"height", height},
                              {"layer", json::array({bound("lower"), bound("upper"), interval, points})}});
}

}  // namespace

double deviation_scale(const ParameterValue& p) {
  return p.nominal != 0 ? std::abs(p.nominal) : (p.upper - p.lower) / 2;
}

std::optional<double> relative_half_width(const RunRecord& record, const ParameterValue& p) {
  if (!record.trust) return std::nullopt;
  for (const ParameterIntervalRecord& own : record.trust->parameters)
    if (own.name == p.name && std::isfinite(own.interval.half_width))
      return own.interval.half_width / deviation_scale(p);
  return std::nullopt;
}

void add_parameter_figure(const Comparison& comparison, const std::string& prefix, Section& section,
                          Document& document) {
  std::vector<std::string> names, labels;
  std::string csv = "label,parameter,first,value,low,high,half_width,lower,upper\n";
  for (const ComparisonRow& row : comparison.rows) {
    const RunRecord& record = *row.shown;
    if (record.parameters.empty() || row.label == "nominal") continue;
    const std::vector<const ParameterValue*> parameters = free_parameters(record);
    const bool first = labels.empty();
    labels.push_back(row.label);
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      const ParameterValue& p = *parameters[i];
      if (first) names.push_back(p.name);
      const auto percent = [&](double v) { return 100 * (v - p.nominal) / deviation_scale(p); };
      // Where there is none the interval has no length and is not seen.
      const std::optional<double> found = relative_half_width(record, p);
      const double half = 100 * found.value_or(0);
      const std::string shown = found ? fmt::format("{:.6g}", half) : "none: decided by the box";
      fmt::format_to(std::back_inserter(csv), "{},{},{},{:.9g},{:.6g},{:.6g},{},{:.9g},{:.9g}\n",
                     csv_field(row.label), csv_field(p.name), first ? 1 : 0, percent(p.value),
                     percent(p.value) - half, percent(p.value) + half, shown, percent(p.lower),
                     percent(p.upper));
    }
  }
  if (names.empty()) return;
  const std::string id = prefix + "parameters";
  const std::string caption =
      "Deviation from nominal in per cent, with the bounds as grey ticks. Bars: 95 % intervals from the "
      "spread "
      "between recordings; a point without a bar is decided by the box or told by too few recordings (table "
      "'Single parameters').";
  document.datasets[id] = csv;
  section.blocks.push_back(Figure{id, "Parameters against their bounds" + comparison.title_suffix, caption,
                                  parameter_spec(id, caption, names, labels, plot_edge(comparison))});
}

std::optional<Table> weak_directions(const RunRecord& record) {
  const std::vector<const ParameterValue*> parameters = free_parameters(record);
  const std::size_t n = parameters.size();
  const std::vector<double>* values = series_of(record, "singular_values", n);
  const std::vector<double>* directions = series_of(record, "directions", n * n);
  const std::vector<double>* residual = series_of(record, "residual_deviation", 1);
  if (n == 0 || values == nullptr || directions == nullptr || residual == nullptr) return std::nullopt;
  Table table{"weak_directions", "Directions of parameter space, best determined first", {}, {}, {}};
  table.columns = {{"rank", "no.", "", "", ""},
                   {"singular_value", "singular value", "", "", ""},
                   {"deviation", "deviation along it if samples were independent", "%", "", ""},
                   {"determined", "determined", "", "", "", Align::Left},
                   {"direction", "what moves together", "", "", "", Align::Left}};
  for (std::size_t k = 0; k < n; ++k) {
    const double deviation = (*residual)[0] / (*values)[k];
    double half = 0;  // half the box along the direction, relative
    for (std::size_t i = 0; i < n; ++i)
      half =
          std::max(half, std::abs((*directions)[k * n + i]) * (parameters[i]->upper - parameters[i]->lower) /
                             2 / deviation_scale(*parameters[i]));
    const bool known = std::isfinite(deviation) && deviation < half;
    table.rows.push_back(
        {count_cell(static_cast<double>(k + 1)), significant_cell((*values)[k], 4),
         std::isfinite(deviation) ? significant_cell(100 * deviation, 3) : text_cell("unbounded"),
         text_cell(known ? "yes" : "no"), text_cell(in_words(*directions, k, parameters))});
  }
  table.notes.push_back(
      fmt::format("Singular values of the Jacobian in relative parameters at the result of {}. Determined: "
                  "the deviation is "
                  "smaller than what the box allows along the direction. Numbers in brackets: the parts of "
                  "the unit vector.",
                  record.label));
  return table;
}

namespace {

void add_singular_values(const std::vector<double>& values, const std::string& id, const std::string& suffix,
                         Section& section, Document& document) {
  std::string csv = "rank,value\n";
  for (std::size_t k = 0; k < values.size(); ++k) csv += fmt::format("{},{:.8g}\n", k + 1, values[k]);
  document.datasets[id] = csv;
  const std::string caption =
      "Singular values of the Jacobian in relative parameters: a gap separates what "
      "the data determine from what they do not.";
  const json encoding{
      {"x", {{"field", "rank"}, {"type", "ordinal"}, {"title", "direction"}, {"axis", {{"labelAngle", 0}}}}},
      {"y", vega::logarithmic("value", "singular value")}};
  section.blocks.push_back(
      Figure{id, "Singular values" + suffix, caption,
             vega::specification(caption, vega::csv_data(id, {"rank", "value"}), {},
                                 {{"width", kFigureWidth},
                                  {"height", 240},
                                  {"mark", {{"type", "line"}, {"point", true}, {"tooltip", true}}},
                                  {"encoding", encoding}})});
}

// `correlation`: a row for each of `names` after the other.
void add_correlation(const std::vector<double>& correlation, const std::vector<std::string>& names,
                     const std::string& id, const std::string& suffix, Section& section, Document& document) {
  const std::size_t n = names.size();
  std::string csv = "row,column,correlation\n";
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      if (std::isfinite(correlation[i * n + j]))
        csv +=
            fmt::format("{},{},{:.4f}\n", csv_field(names[i]), csv_field(names[j]), correlation[i * n + j]);
  document.datasets[id] = csv;
  const std::string caption =
      "Correlation of the estimated parameters: near 1 or -1 the data see only a combination of the two.";
  const auto axis = [&](const char* field) {
    return json{{"field", field},
                {"type", "nominal"},
                {"sort", names},
                {"title", nullptr},
                {"axis", {{"labelAngle", 0}}}};
  };
  section.blocks.push_back(
      Figure{id, "Correlation of the parameters" + suffix, caption,
             vega::specification(caption, vega::csv_data(id, {"correlation"}), {},
                                 {{"width", kFigureWidth},
                                  {"height", 400},
                                  {"mark", {{"type", "rect"}, {"tooltip", true}}},
                                  {"encoding",
                                   {{"x", axis("column")},
                                    {"y", axis("row")},
                                    {"color",
                                     {{"field", "correlation"},
                                      {"type", "quantitative"},
                                      {"title", "correlation"},
                                      {"scale", {{"domain", {-1, 1}}, {"domainMid", 0}}}}}}}})});
}

}  // namespace

void add_identifiability(const Comparison& comparison, const std::string& prefix, Section& section,
                         Document& document) {
  const RunRecord* record = best_described(comparison);
  if (record == nullptr) return;
  std::vector<std::string> names;
  for (const ParameterValue* p : free_parameters(*record)) names.push_back(p->name);
  const std::size_t n = names.size();
  if (std::optional<Table> table = weak_directions(*record)) {
    table->id = prefix + table->id;
    table->title += comparison.title_suffix;
    section.blocks.push_back(std::move(*table));
  }
  if (const std::vector<double>* values = series_of(*record, "singular_values", n))
    add_singular_values(*values, prefix + "singular_values", comparison.title_suffix, section, document);
  if (const std::vector<double>* correlation = series_of(*record, "correlation", n * n))
    add_correlation(*correlation, names, prefix + "correlation", comparison.title_suffix, section, document);
}

}  // namespace odobench
