#include "reports/kinds/trust/profile_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/range.hpp"
#include "reports/figures/vega.hpp"
#include "reports/kinds/trust/trust_tables.hpp"
#include "reports/records/series.hpp"

namespace odobench {
namespace {

using vega::json;

std::string key(const std::string& parameter, const char* what) {
  return "profile." + parameter + "." + what;
}

const RunRecord* first_profiled(const Comparison& comparison) {
  for (const ComparisonRow& row : comparison.rows)
    for (const RunRecord* run : row.runs)
      if (!profiles_of(*run).empty()) return run;
  return nullptr;
}

const ParameterValue& parameter_of(const RunRecord& record, const std::string& name) {
  return *std::find_if(record.parameters.begin(), record.parameters.end(),
                       [&](const ParameterValue& p) { return p.name == name; });
}

const IntervalRecord* interval_of(const RunRecord& record, const std::string& name) {
  if (!record.trust) return nullptr;
  for (const ParameterIntervalRecord& p : record.trust->parameters)
    if (p.name == name) return &p.interval;
  return nullptr;
}

// "to the bound below"; "" where both ends are inside.
std::string open_ends(const ProfileFigures& p) {
  if (std::isnan(p.rise)) return "";
  if (std::isinf(p.lower) && std::isinf(p.upper)) return "to both bounds";
  if (std::isinf(p.lower)) return "to the bound below";
  return std::isinf(p.upper) ? "to the bound above" : "";
}

std::size_t place_of_lowest(const ProfileFigures& p) {
  return static_cast<std::size_t>(std::min_element(p.costs.begin(), p.costs.end()) - p.costs.begin());
}

}  // namespace

void put_profiles(const std::vector<ProfileFigures>& figures, RunRecord& record) {
  for (const ProfileFigures& p : figures) {
    const std::string& unit = parameter_of(record, p.parameter).unit;
    if (!std::isnan(p.rise)) {
      record.measures.put({key(p.parameter, "rise"), p.rise, "", Better::None, p.parameter});
      if (std::isfinite(p.lower))
        record.measures.put({key(p.parameter, "lower"), p.lower, unit, Better::None, p.parameter});
      if (std::isfinite(p.upper))
        record.measures.put({key(p.parameter, "upper"), p.upper, unit, Better::None, p.parameter});
    }
    record.series[key(p.parameter, "value")] = p.values;
    record.series[key(p.parameter, "cost")] = p.costs;
  }
}

std::vector<ProfileFigures> profiles_of(const RunRecord& record) {
  std::vector<ProfileFigures> list;
  for (const ParameterValue& p : record.parameters) {
    const auto values = record.series.find(key(p.name, "value"));
    if (values == record.series.end() || values->second.empty()) continue;
    const auto* costs = series_of(record, key(p.name, "cost").c_str(), values->second.size());
    if (costs == nullptr) continue;
    const std::optional<double> rise = record.measures.value(key(p.name, "rise"));
    ProfileFigures one{p.name, values->second, *costs, rise.value_or(kNotANumber), kNotANumber, kNotANumber};
    if (rise) {
      one.lower = record.measures.value(key(p.name, "lower")).value_or(-kInfinity);
      one.upper = record.measures.value(key(p.name, "upper")).value_or(kInfinity);
    }
    list.push_back(std::move(one));
  }
  return list;
}

std::optional<Table> profile_table(const Comparison& comparison) {
  const RunRecord* record = first_profiled(comparison);
  if (record == nullptr) return std::nullopt;
  Table table;
  table.id = comparison.id_prefix + "profile";
  table.key = true;
  table.title = fmt::format("J along single parameters, all others fitted again, of {}{}", record->label,
                            comparison.title_suffix);
  table.columns = {text_column("parameter"),
                   text_column("unit"),
                   number_column("value"),
                   number_column("lower", "95 % from"),
                   number_column("upper", "to"),
                   text_column("open", "goes on"),
                   number_column("rise", "J may rise by"),
                   number_column("half_width", "+- (recordings left out)"),
                   text_column("reason", "why no interval")};
  bool lower_found = false;
  for (const ProfileFigures& p : profiles_of(*record)) {
    const ParameterValue& parameter = parameter_of(*record, p.parameter);
    const ReadUnit unit = read_unit(parameter.unit);
    const IntervalRecord* beside = interval_of(*record, p.parameter);
    const auto cell = [&](double value) {
      return std::isfinite(value) ? fixed_cell(unit.factor * value, 3) : Cell{};
    };
    const std::string why = beside == nullptr ? "" : beside->reason;
    table.rows.push_back({text_cell(p.parameter), text_cell(unit.name), cell(parameter.value), cell(p.lower),
                          cell(p.upper), text_cell(open_ends(p)),
                          std::isfinite(p.rise) ? significant_cell(p.rise, 4) : Cell{},
                          beside == nullptr ? Cell{} : cell(beside->half_width), text_cell(why)});
    lower_found = lower_found || (record->cost && p.costs[place_of_lowest(p)] < *record->cost * (1 - 1e-9));
  }
  table.notes.emplace_back(
      "From .. to: where J stays within the rise that moves of the result allow when recordings are left "
      "out. "
      "What goes on to a bound is decided by the box there.");
  if (lower_found)
    table.notes.emplace_back(
        "Along a parameter a lower J was found than that of the result: another valley.");
  return table;
}

void add_profile_figures(const Comparison& comparison, const std::string& prefix, Section& section,
                         Document& document) {
  const RunRecord* record = first_profiled(comparison);
  if (record == nullptr) return;
  std::string csv = "parameter,value,rise,limit\n";
  std::vector<std::string> names;
  for (const ProfileFigures& p : profiles_of(*record)) {
    names.push_back(p.parameter);
    const ReadUnit unit = read_unit(parameter_of(*record, p.parameter).unit);
    const double lowest = p.costs[place_of_lowest(p)];
    for (std::size_t k = 0; k < p.values.size(); ++k)
      if (std::isfinite(p.costs[k]))
        csv += fmt::format("{},{:.9g},{:.9g},{}\n", csv_field(p.parameter), unit.factor * p.values[k],
                           p.costs[k] - lowest, std::isfinite(p.rise) ? fmt::format("{:.9g}", p.rise) : "");
  }
  const std::string id = prefix + "profile";
  const std::string caption =
      "J above its minimum with one parameter held and all others fitted again (line, points: fits). Dashed: "
      "how far it may rise within the 95 % interval; a line that stays below it to a bound has no end there.";
  document.datasets[id] = csv;
  const std::vector<std::pair<std::string, std::string>> options = [&] {
    std::vector<std::pair<std::string, std::string>> list;
    for (const std::string& name : names) list.emplace_back(name, name);
    return list;
  }();
  const vega::Choice choice{"parameter", "parameter", options, names.front()};
  const json x = vega::quantitative("value", "value [mm, deg, or the parameter's unit]");
  json limit = vega::quantitative("limit", "J above its minimum");
  const json spec{
      {"width", 640},
      {"height", 280},
      {"transform", {vega::filter("datum.parameter == parameter")}},
      {"layer", json::array({json{{"mark", {{"type", "line"}, {"style", "reference"}}},
                                  {"encoding", {{"x", x}, {"y", limit}}}},
                             json{{"mark", {{"type", "line"}, {"point", true}, {"tooltip", true}}},
                                  {"encoding",
                                   {{"x", x}, {"y", vega::quantitative("rise", "J above its minimum")}}}}})}};
  section.blocks.push_back(
      Figure{id, "J along single parameters" + comparison.title_suffix, caption,
             vega::specification(caption, vega::csv_data(id, {"value", "rise", "limit"}), {choice}, spec)});
}

}  // namespace odobench
