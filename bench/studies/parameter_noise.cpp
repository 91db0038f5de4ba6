#include "bench/studies/parameter_noise.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace odobench {

nlohmann::ordered_json noise_json(const NoiseFigures& f) {
  using Json = nlohmann::ordered_json;
  Json terms = Json::object();
  for (const NoiseTermFigures& t : f.terms)
    terms[t.name] = {
        {"value", t.value}, {"lower", t.lower}, {"upper", t.upper}, {"total", t.total}, {"unit", t.unit}};
  Json check;
  if (f.checked > 0)
    check = {{"drives", f.checked}, {"nees", f.nees}, {"lower", f.nees_lower}, {"upper", f.nees_upper}};
  return {{"terms", terms},       {"speed", f.speed},   {"turn_rate", f.turn_rate}, {"metres", f.metres},
          {"radians", f.radians}, {"drives", f.drives}, {"separated", f.separated}, {"check", check}};
}

NoiseFigures noise_from(const JsonNode& node) {
  NoiseFigures f;
  const JsonNode terms = node.at("terms");
  for (const std::string& name : terms.keys())
    if (std::none_of(kNoiseTermNames.begin(), kNoiseTermNames.end(),
                     [&](const NoiseTermName& t) { return t.name == name; }))
      terms.at(name).fail("an unknown term", "one of docs/noise.md");
  for (const NoiseTermName& known : kNoiseTermNames) {
    const std::optional<JsonNode> one = terms.find(known.name);
    if (!one) continue;
    for (const char* key : {"value", "total"})
      if (known.root_unit[0] != '\0' && one->at(key).number() < 0)
        one->at(key).fail("a variance, at least 0");
    f.terms.push_back({known.name, one->at("unit").text(), one->at("value").number(),
                       one->at("lower").number(), one->at("upper").number(), one->at("total").number()});
  }
  f.speed = node.at("speed").number();
  f.turn_rate = node.at("turn_rate").number();
  f.metres = node.at("metres").number();
  f.radians = node.at("radians").number();
  f.drives = node.at("drives").number();
  f.separated = node.at("separated").boolean();
  if (const JsonNode check = node.at("check"); check.is_object()) {
    f.checked = check.at("drives").number();
    f.nees = check.at("nees").number();
    f.nees_lower = check.at("lower").number();
    f.nees_upper = check.at("upper").number();
  }
  return f;
}

}  // namespace odobench
