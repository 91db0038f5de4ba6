#include "reports/records/trust_record.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/json_node.hpp"
#include "base/range.hpp"

namespace odobench {
namespace {

using nlohmann::json;

// The fields of an interval stand beside those of what it is of.
json with_interval(json out, const IntervalRecord& i) {
  const std::pair<const char*, double> numbers[] = {
      {"sd", i.deviation},           {"df", i.df},           {"half_width", i.half_width},
      {"same_sd", i.same_deviation}, {"same_df", i.same_df}, {"same_half_width", i.same_half_width}};
  for (const auto& [name, value] : numbers) out[name] = finite_or_null(value);
  if (i.refused != "none") out["refused"] = i.refused;
  if (!i.reason.empty()) out["reason"] = i.reason;
  return out;
}

IntervalRecord interval_from(const JsonNode& node) {
  IntervalRecord i;
  i.deviation = node.at("sd").stored_number();
  i.df = node.at("df").stored_number();
  i.half_width = node.at("half_width").stored_number();
  i.same_deviation = node.at("same_sd").stored_number();
  i.same_df = node.at("same_df").stored_number();
  i.same_half_width = node.at("same_half_width").stored_number();
  if (const auto refused = node.find("refused")) i.refused = refused->text();
  i.reason = node.text_or_empty("reason");
  return i;
}

std::vector<std::string> texts_from(const JsonNode& node) {
  std::vector<std::string> texts;
  for (const JsonNode& one : node.elements()) texts.push_back(one.text());
  return texts;
}

json explanation_json(const ExplanationRecord& e) {
  json out{{"model", e.model},
           {"words", e.words},
           {"cost", finite_or_null(e.cost)},
           {"explained", finite_or_null(e.explained)},
           {"of_the_robot", e.robot},
           {"on_bound", e.on_bound}};
  if (!e.parameter.empty()) {
    out["parameter"] = e.parameter;
    out["unit"] = e.unit;
    out["value"] = finite_or_null(e.value);
  }
  return out;
}

ExplanationRecord explanation_from(const JsonNode& node) {
  ExplanationRecord e;
  e.model = node.at("model").text();
  e.words = node.at("words").text();
  e.cost = node.at("cost").stored_number();
  e.explained = node.at("explained").stored_number();
  e.robot = node.at("of_the_robot").boolean();
  e.on_bound = node.at("on_bound").boolean();
  e.parameter = node.text_or_empty("parameter");
  e.unit = node.text_or_empty("unit");
  if (const auto value = node.find("value")) e.value = value->stored_number();
  return e;
}

json next_json(const NextStepsRecord& next) {
  if (!next.skipped.empty()) return {{"skipped", next.skipped}};
  json out{{"first_words", next.first_words},
           {"second_words", next.second_words},
           {"open", json(next.open)},
           {"settled", json(next.settled)},
           {"largest_before", finite_or_null(next.largest_before)},
           {"largest_after", finite_or_null(next.largest_after)},
           {"drives", json::array()}};
  for (const NextDriveRecord& d : next.drives)
    out["drives"].push_back({{"purpose", d.purpose},
                             {"first", d.first},
                             {"second", d.second},
                             {"drive", d.drive},
                             {"description", d.description},
                             {"recorded", d.recorded},
                             {"repetitions", d.repetitions},
                             {"separation", finite_or_null(d.separation)},
                             {"probability", finite_or_null(d.probability)},
                             {"seconds", finite_or_null(d.seconds)}});
  return out;
}

NextStepsRecord next_from(const JsonNode& node) {
  NextStepsRecord next;
  next.skipped = node.text_or_empty("skipped");
  if (!next.skipped.empty()) return next;
  next.first_words = node.at("first_words").text();
  next.second_words = node.at("second_words").text();
  next.open = texts_from(node.at("open"));
  next.settled = texts_from(node.at("settled"));
  next.largest_before = node.at("largest_before").stored_number();
  next.largest_after = node.at("largest_after").stored_number();
  for (const JsonNode& d : node.at("drives").elements())
    next.drives.push_back({d.at("purpose").text(), d.at("first").text(), d.at("second").text(),
                           d.at("drive").text(), d.at("description").text(), d.at("recorded").boolean(),
                           d.at("repetitions").small_integer(), d.at("separation").stored_number(),
                           d.at("probability").stored_number(), d.at("seconds").stored_number()});
  return next;
}

}  // namespace

IntervalRecord::IntervalRecord()
    : deviation(kNotANumber),
      df(kNotANumber),
      half_width(kNotANumber),
      same_deviation(kNotANumber),
      same_df(kNotANumber),
      same_half_width(kNotANumber) {}

TrustRecord::TrustRecord() : kind_f(kNotANumber), kind_p(kNotANumber) {}

std::vector<Measure> trust_measures(const TrustRecord& trust) {
  std::vector<Measure> list;
  double told = 0, single = 0;
  for (const DeterminedRecord& d : trust.determined) {
    const std::string name = "trust." + d.name;
    list.push_back({name, d.value, d.unit, Better::None, d.name});
    if (std::isfinite(d.interval.half_width)) {
      list.push_back({name + ".half_width", d.interval.half_width, d.unit, Better::Lower, d.name});
      ++told;
    }
    if (std::isfinite(d.interval.same_half_width))
      list.push_back({name + ".same_half_width", d.interval.same_half_width, d.unit, Better::Lower, d.name});
  }
  for (const ParameterIntervalRecord& p : trust.parameters)
    if (std::isfinite(p.interval.half_width)) ++single;
  list.push_back({"trust.intervals", told, "", Better::Higher});
  list.push_back({"trust.single_intervals", single, "", Better::Higher});
  return list;
}

json to_json(const TrustRecord& trust) {
  json out{{"recordings", trust.recordings},
           {"kinds", trust.kinds},
           {"exact_hessian", trust.exact_hessian},
           {"kind_f", finite_or_null(trust.kind_f)},
           {"kind_p", finite_or_null(trust.kind_p)},
           {"systematic", trust.systematic},
           {"determined", json::array()},
           {"parameters", json::array()},
           {"drives", json::array()},
           {"remarks", json(trust.remarks)},
           {"sentences", json(trust.sentences)}};
  for (const DeterminedRecord& d : trust.determined)
    out["determined"].push_back(with_interval({{"name", d.name},
                                               {"words", d.words},
                                               {"unit", d.unit},
                                               {"nominal", finite_or_null(d.nominal)},
                                               {"value", finite_or_null(d.value)}},
                                              d.interval));
  if (trust.ratios_only) out["ratios_only"] = true;
  for (const ParameterIntervalRecord& p : trust.parameters)
    out["parameters"].push_back(
        with_interval({{"name", p.name}, {"unit", p.unit}, {"value", finite_or_null(p.value)}}, p.interval));
  for (const DriveErrorRecord& d : trust.drives)
    out["drives"].push_back(with_interval(
        {{"drive", d.drive}, {"what", d.what}, {"unit", d.unit}, {"scatter", finite_or_null(d.scatter)}},
        d.interval));
  if (trust.twice_box) out["twice_box"] = finite_or_null(*trust.twice_box);
  for (const ExplanationRecord& e : trust.explanations) out["explanations"].push_back(explanation_json(e));
  if (trust.next) out["next"] = next_json(*trust.next);
  for (const CombinationRecord& c : trust.combinations)
    out["combinations"].push_back(with_interval({{"name", c.name},
                                                 {"formula", c.formula},
                                                 {"unit", c.unit},
                                                 {"nominal", finite_or_null(c.nominal)},
                                                 {"value", finite_or_null(c.value)},
                                                 {"of_the_map", c.of_the_map}},
                                                c.interval));
  return out;
}

TrustRecord trust_from(const JsonNode& node) {
  TrustRecord trust;
  trust.recordings = node.at("recordings").small_integer();
  trust.kinds = node.at("kinds").small_integer();
  trust.exact_hessian = node.at("exact_hessian").boolean();
  trust.kind_f = node.at("kind_f").stored_number();
  trust.kind_p = node.at("kind_p").stored_number();
  trust.systematic = node.at("systematic").boolean();
  trust.ratios_only = node.has("ratios_only") && node.at("ratios_only").boolean();
  for (const JsonNode& d : node.at("determined").elements())
    trust.determined.push_back({d.at("name").text(), d.at("words").text(), d.at("unit").text(),
                                d.at("nominal").stored_number(), d.at("value").stored_number(),
                                interval_from(d)});
  for (const JsonNode& p : node.at("parameters").elements())
    trust.parameters.push_back(
        {p.at("name").text(), p.at("unit").text(), p.at("value").stored_number(), interval_from(p)});
  for (const JsonNode& d : node.at("drives").elements())
    trust.drives.push_back({d.at("drive").text(), d.at("what").text(), d.at("unit").text(),
                            d.at("scatter").stored_number(), interval_from(d)});
  if (const auto twice = node.find("twice_box")) trust.twice_box = twice->stored_number();
  if (const auto list = node.find("explanations"))
    for (const JsonNode& e : list->elements()) trust.explanations.push_back(explanation_from(e));
  if (const auto next = node.find("next")) trust.next = next_from(*next);
  if (const auto combinations = node.find("combinations"))
    for (const JsonNode& c : combinations->elements())
      trust.combinations.push_back({c.at("name").text(), c.at("formula").text(), c.at("unit").text(),
                                    c.at("nominal").stored_number(), c.at("value").stored_number(),
                                    c.at("of_the_map").boolean(), interval_from(c)});
  trust.remarks = texts_from(node.at("remarks"));
  trust.sentences = texts_from(node.at("sentences"));
  return trust;
}

}  // namespace odobench
