#include "reports/figures/vega.hpp"

#include <cctype>

namespace odobench::vega {

json csv_data(const std::string& name, const std::vector<std::string>& numbers) {
  json parse = json::object();
  for (const std::string& column : numbers) parse[column] = "number";
  return {{"name", name}, {"format", {{"type", "csv"}, {"parse", parse}}}};
}

namespace {

json titled(json channel, const std::string& title) {
  channel["title"] = title.empty() ? json(nullptr) : json(title);
  return channel;
}

}  // namespace

json quantitative(const std::string& field, const std::string& title) {
  return titled({{"field", field}, {"type", "quantitative"}, {"scale", {{"zero", false}}}}, title);
}

json logarithmic(const std::string& field, const std::string& title) {
  // Of a decade only 1, 2 and 5 are named.
  constexpr const char* kLabel =
      "indexof([1, 2, 5], round(datum.value / pow(10, floor(log(datum.value) / LN10 + 1e-9)))) < 0 ? '' : "
      "datum.value < 0.001 || datum.value >= 100000 ? format(datum.value, '.0e') : format(datum.value, '~g')";
  return titled({{"field", field},
                 {"type", "quantitative"},
                 {"scale", {{"type", "log"}}},
                 {"axis", {{"labelExpr", kLabel}}}},
                title);
}

json nominal(const std::string& field, const std::string& title, const std::vector<std::string>& domain) {
  return titled({{"field", field}, {"type", "nominal"}, {"sort", domain}, {"scale", {{"domain", domain}}}},
                title);
}

json line_color(const std::string& field, const std::vector<std::string>& domain) {
  json channel = nominal(field, "", domain);
  channel["legend"] = {{"symbolType", "stroke"}, {"symbolOpacity", 1}, {"symbolStrokeWidth", 2.5}};
  return channel;
}

json name_of(const std::string& index, const std::vector<std::string>& names, const std::string& as) {
  return {{"calculate", json(names).dump() + "[datum." + index + "]"}, {"as", as}};
}

json filter(const std::string& expression) {
  return {{"filter", expression}};
}

json specification(const std::string& description, json data, const std::vector<Choice>& choices, json body) {
  json spec{{"$schema", "https://vega.github.io/schema/vega-lite/v6.json"},
            {"description", description},
            {"data", std::move(data)}};
  for (const Choice& choice : choices) {
    spec["params"].push_back({{"name", choice.parameter}, {"value", choice.chosen}});
    json options = json::array();
    for (const auto& [value, label] : choice.options) options.push_back({{"value", value}, {"label", label}});
    spec["usermeta"]["odobench"]["controls"].push_back(
        {{"param", choice.parameter}, {"label", choice.label}, {"options", options}});
  }
  spec.update(body);
  return spec;
}

Choice choice_of(const std::string& parameter, const std::string& label, const std::string& all,
                 const std::vector<std::string>& names) {
  Choice choice{parameter, label, {{"all", all}}, "all"};
  for (const std::string& name : names) choice.options.emplace_back(name, name);
  return choice;
}

std::string slug(const std::string& text) {
  std::string id;
  for (const char c : text)
    id += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' ? c : '-';
  return id;
}

}  // namespace odobench::vega
