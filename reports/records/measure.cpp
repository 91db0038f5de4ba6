#include "reports/records/measure.hpp"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/json_node.hpp"

namespace odobench {
namespace {

constexpr std::array<std::pair<Better, const char*>, 3> kDirectionWords{
    {{Better::None, "none"}, {Better::Lower, "lower"}, {Better::Higher, "higher"}}};

const char* direction_word(Better better) {
  for (const auto& [direction, word] : kDirectionWords)
    if (direction == better) return word;
  return "none";
}

Better direction_from(const JsonNode& node) {
  const std::string text = node.text();
  for (const auto& [direction, word] : kDirectionWords)
    if (text == word) return direction;
  node.fail("\"lower\", \"higher\" or \"none\"");
}

Measure measure_from(const JsonNode& node) {
  Measure m{node.at("name").text(), node.at("value").stored_number(), node.at("unit").text(),
            direction_from(node.at("better"))};
  if (m.name.empty()) node.at("name").fail("a name");
  m.of = node.text_or_empty("of");
  if (const auto timing = node.find("timing")) m.timing = timing->boolean();
  return m;
}

}  // namespace

Measures::Measures(std::initializer_list<Measure> list) {
  for (const Measure& measure : list) put(measure);
}

void Measures::put(Measure measure) {
  if (const auto old = list_.find(measure); old != list_.end()) list_.erase(old);
  list_.insert(std::move(measure));
}

const Measure* Measures::find(std::string_view name) const {
  const auto found = list_.find(name);
  return found == list_.end() ? nullptr : &*found;
}

std::optional<double> Measures::value(std::string_view name) const {
  const Measure* measure = find(name);
  return measure == nullptr ? std::nullopt : std::optional<double>(measure->value);
}

std::vector<std::string> Measures::subjects() const {
  std::set<std::string> names;
  for (const Measure& measure : list_)
    if (!measure.of.empty()) names.insert(measure.of);
  return {names.begin(), names.end()};
}

nlohmann::json to_json(const Measures& measures) {
  nlohmann::json list = nlohmann::json::array();
  for (const Measure& m : measures) {
    list.push_back({{"name", m.name},
                    {"value", finite_or_null(m.value)},
                    {"unit", m.unit},
                    {"better", direction_word(m.better)}});
    if (!m.of.empty()) list.back()["of"] = m.of;
    if (m.timing) list.back()["timing"] = true;
  }
  return list;
}

Measures measures_from(const JsonNode& list) {
  Measures measures;
  for (const JsonNode& item : list.elements()) {
    Measure measure = measure_from(item);
    if (measures.find(measure.name) != nullptr)
      item.at("name").fail(fmt::format("\"{}\" a second time", measure.name), "every name once");
    measures.put(std::move(measure));
  }
  return measures;
}

}  // namespace odobench
