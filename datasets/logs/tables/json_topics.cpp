#include "datasets/logs/tables/json_topics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "base/files.hpp"
#include "base/text.hpp"

namespace odobench {
namespace {

constexpr std::size_t kLineSamples = 24, kLongestSample = 48, kLongestFirst = 80;
constexpr std::size_t kMostTopics = 65'536;

std::string text_of(const JsonLeaf& leaf) {
  switch (leaf.kind) {
    case JsonLeaf::Kind::Whole:
      return std::to_string(leaf.whole);
    case JsonLeaf::Kind::Bool:
      return leaf.whole != 0 ? "true" : "false";
    case JsonLeaf::Kind::Real:
    case JsonLeaf::Kind::Text:
      return leaf.text;
    case JsonLeaf::Kind::Nothing:
      break;
  }
  return "";
}

std::string type_of(const JsonLeaf& leaf) {
  if (leaf.kind == JsonLeaf::Kind::Bool) return "bool";
  return leaf.kind == JsonLeaf::Kind::Text ? "text" : "number";
}

}  // namespace

std::optional<std::int64_t> stamp_of(const JsonLeaf& leaf, const TimeUnit& unit) {
  switch (leaf.kind) {
    case JsonLeaf::Kind::Whole:
      return unit.of(leaf.whole);
    case JsonLeaf::Kind::Real:
    case JsonLeaf::Kind::Text:
      return unit.of(std::string_view(leaf.text));
    default:
      return std::nullopt;
  }
}

JsonTopics::Topic& JsonTopics::topic_of_line() {
  const bool named = paths_.has(topic_node_) && paths_.leaf(topic_node_).kind == JsonLeaf::Kind::Text;
  const std::string name = named ? paths_.leaf(topic_node_).text : "";
  const auto [at, fresh] = place_.emplace(name, topics_.size());
  if (fresh) topics_.emplace_back(name, Topic());
  if (topics_.size() > kMostTopics)
    throw DataError(
        fmt::format("{}: found more than {} topics, expected fewer", shown_path(file_), kMostTopics));
  return topics_[at->second].second;
}

void JsonTopics::take_sample(Topic& topic, std::size_t node) {
  const JsonLeaf& leaf = paths_.leaf(node);
  const auto [at, fresh] = topic.place.emplace(node, topic.fields.size());
  if (fresh) {
    topic.fields.push_back(
        {node, {paths_.path(node), type_of(leaf), text_of(leaf).substr(0, kLongestFirst)}, {}});
    if (++fields_ > kMostFields)
      throw DataError(
          fmt::format("{}: found more than {} fields, expected fewer", shown_path(file_), kMostFields));
  }
  Field& field = topic.fields[at->second];
  if (topic.decided || field.samples.size() >= kLineSamples) return;
  const std::string text = text_of(leaf);
  if (text.size() <= kLongestSample) field.samples.push_back(text);
}

void JsonTopics::take_line() {
  Topic& topic = topic_of_line();
  for (const std::size_t node : paths_.seen())
    if (node != topic_node_ && paths_.has(node)) take_sample(topic, node);
  ++topic.rows;
  if (topic.decided) {
    if (topic.time == JsonPaths::kNone || !paths_.has(topic.time)) return;
    if (const auto stamp = stamp_of(paths_.leaf(topic.time), TimeUnit(topic.unit))) topic.stamps.add(*stamp);
  } else if (topic.rows >= static_cast<std::int64_t>(kLineSamples)) {
    decide(topic);
  }
}

// Which field tells time, from the samples; their stamps are taken, the samples thrown away.
void JsonTopics::decide(Topic& topic) {
  topic.decided = true;
  for (const bool named : {true, false})
    for (const Field& field : topic.fields) {
      const std::string& path = field.info.path;
      const std::string leaf_name = path.substr(path.find_last_of('.') + 1);
      if (topic.time != JsonPaths::kNone || (named && !name_tells_time(leaf_name))) continue;
      std::string unit = named && field.info.type == "number" ? time_unit_of_name(leaf_name) : "";
      if (unit.empty()) unit = time_unit_of_values(field.samples);
      if (unit.empty()) continue;
      topic.time = field.node;
      topic.unit = unit;
      for (const std::string& sample : field.samples)
        if (const auto stamp = TimeUnit(unit).of(std::string_view(sample))) topic.stamps.add(*stamp);
    }
}

bool JsonTopics::decided(const std::string& name) const {
  const auto found = place_.find(name);
  return found != place_.end() && topics_[found->second].second.decided;
}

void JsonTopics::find_time(const std::string& name, std::string& path, std::string& unit) {
  const auto found = place_.find(name);
  std::vector<std::string> names;
  for (const auto& [other, topic] : topics_) names.push_back(other);
  if (found == place_.end()) refuse_unknown("source", name, shown_path(file_), names);
  Topic& topic = topics_[found->second].second;
  if (!topic.decided) decide(topic);
  if (path.empty() && topic.time != JsonPaths::kNone) path = paths_.path(topic.time);
  if (path.empty())
    throw std::invalid_argument(
        fmt::format("{}: found no field of '{}' that tells time, expected \"time\" and "
                    "\"time_unit\"",
                    shown_path(file_), shown(name)));
  if (!unit.empty()) return;
  if (topic.time != JsonPaths::kNone && path == paths_.path(topic.time)) {
    unit = topic.unit;
    return;
  }
  names.clear();
  for (const Field& field : topic.fields) {
    names.push_back(field.info.path);
    if (field.info.path != path) continue;
    unit = time_unit_of_name(path);
    if (unit.empty()) unit = time_unit_of_values(field.samples);
    if (unit.empty())
      throw std::invalid_argument(
          fmt::format("{}: field '{}' does not tell its unit of time by name or size, "
                      "expected \"time_unit\"",
                      shown_path(file_), shown(path)));
    return;
  }
  refuse_unknown("field", path, name.empty() ? shown_path(file_) : shown(name), names);
}

std::vector<LogSource> JsonTopics::sources() {
  std::vector<LogSource> sources;
  for (auto& [name, topic] : topics_) {
    if (!topic.decided) decide(topic);
    LogSource source;
    source.name = name;
    source.type = "table";
    for (const Field& field : topic.fields) source.fields.push_back(field.info);
    source.rows = topic.rows;
    topic.stamps.give(source);
    sources.push_back(std::move(source));
  }
  return sources;
}

}  // namespace odobench
