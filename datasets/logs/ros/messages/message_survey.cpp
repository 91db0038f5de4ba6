#include "datasets/logs/ros/messages/message_survey.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace odobench {
namespace {

constexpr std::size_t kMostListedFields = 2000;  // of a channel
constexpr std::uint64_t kShortArray = 16;        // is listed whole, of a longer one kListedOfLong
constexpr std::uint64_t kListedOfLong = 3;
constexpr std::uint64_t kMostListedNames = 256;  // names or frames in one message
constexpr std::size_t kLongestListedText = 200;
constexpr std::int64_t kFirstMessages = 500, kOtherwiseEvery = 64;
constexpr std::size_t kMostSizes = 1000;

const std::string* value_of(const std::vector<LogField>& found, std::string_view path) {
  for (const LogField& f : found)
    if (f.path == path && f.type == "string") return &f.first;
  return nullptr;
}

// How an element of an array is told from the others: "header.frame_id=odom,child_frame_id=base", "name=x";
// "" when nothing does.
std::string selector_of(const std::vector<LogField>& element) {
  const std::string *frame = value_of(element, "header.frame_id"),
                    *child = value_of(element, "child_frame_id"), *name = value_of(element, "name");
  if (frame != nullptr && child != nullptr)
    return fmt::format("header.frame_id={},child_frame_id={}", *frame, *child);
  return name != nullptr ? fmt::format("name={}", *name) : "";
}

}  // namespace

void MessageSurvey::add(std::string_view message) {
  const bool odd_size = sizes_.size() < kMostSizes && sizes_.insert(message.size()).second;
  const std::int64_t number = messages_++;
  if (number >= kFirstMessages && !odd_size && number % kOtherwiseEvery != 0) return;
  wire_ = MessageWire(encoding_, message);
  Found found;
  this->message(0, found, fields_.size() < kMostListedFields);
  wire_.require_end();
  for (LogField& f : found)
    if (fields_.size() < kMostListedFields && known_.insert(f.path).second) fields_.push_back(std::move(f));
}

void MessageSurvey::message(std::size_t type, Found& found, bool list) {
  wire_.count_elements(1);
  std::vector<std::string> names;  // of the last array of strings
  std::string names_field;
  for (const RosField& f : types_->types[type].fields)
    field(f, names, names_field, found, list && found.size() < kMostListedFields);
}

void MessageSurvey::field(const RosField& f, std::vector<std::string>& names, std::string& names_field,
                          Found& found, bool list) {
  const bool array = f.array != RosField::Array::None;
  const std::uint64_t count = f.array == RosField::Array::Sequence ? wire_.length() : f.length;
  if (f.primitive == RosPrimitive::Message && array) return messages(f, count, found, list);
  if (f.primitive == RosPrimitive::Message) {
    Found inside;
    message(f.type, inside, list);
    if (list && types_->types[f.type].name == "geometry_msgs/Quaternion")
      found.push_back({f.name, "quaternion", ""});
    for (LogField& part : inside) {
      part.path = f.name + "." + part.path;
      found.push_back(std::move(part));
    }
    return;
  }
  if (f.primitive != RosPrimitive::String)
    return numbers(f, array ? count : 1, names, names_field, found, list);
  if (!array) {
    const std::string_view text = wire_.string();
    if (list) found.push_back({f.name, "string", std::string(text.substr(0, kLongestListedText))});
    return;
  }
  wire_.count_elements(count);
  names.clear();
  names_field = f.name;
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::string_view text = wire_.string();
    if (i < kMostListedNames) names.emplace_back(text.substr(0, kLongestListedText));
    if (list && i < kShortArray)
      found.push_back(
          {fmt::format("{}[{}]", f.name, i), "string", std::string(text.substr(0, kLongestListedText))});
  }
}

void MessageSurvey::numbers(const RosField& f, std::uint64_t count, const std::vector<std::string>& names,
                            const std::string& names_field, Found& found, bool list) {
  const std::uint64_t size = primitive_size(f.primitive);
  if (count > 0) wire_.align(f.primitive == RosPrimitive::Time ? 4 : size);
  wire_.need(count * size);
  const char* bytes = wire_.here();
  wire_.at += count * size;
  if (!list) return;
  const std::string type = primitive_name(f.primitive);
  if (f.array == RosField::Array::None) {
    found.push_back({f.name, type, number_text(f.primitive, bytes)});
    return;
  }
  const bool named = count == names.size() && count > 0;
  const std::uint64_t listed = named || count <= kShortArray ? count : kListedOfLong;
  for (std::uint64_t i = 0; i < listed; ++i)
    found.push_back(
        {named ? fmt::format("{}[{}={}]", f.name, names_field, names[i]) : fmt::format("{}[{}]", f.name, i),
         type, number_text(f.primitive, bytes + i * size)});
}

void MessageSurvey::messages(const RosField& f, std::uint64_t count, Found& found, bool list) {
  wire_.count_elements(count);
  for (std::uint64_t i = 0; i < count; ++i) {
    Found element;
    const bool listed = list && i < kMostListedNames && found.size() < kMostListedFields;
    message(f.type, element, listed);
    if (!listed) continue;
    const std::string selector = selector_of(element);
    if (selector.empty() && i >= kShortArray) continue;
    const std::string prefix =
        selector.empty() ? fmt::format("{}[{}].", f.name, i) : fmt::format("{}[{}].", f.name, selector);
    for (LogField& part : element) {
      part.path = prefix + part.path;
      found.push_back(std::move(part));
    }
  }
}

std::string MessageSurvey::number_text(RosPrimitive primitive, const char* bytes) const {
  switch (primitive) {
    case RosPrimitive::Float32:
      return fmt::format("{}", static_cast<float>(wire_.value(primitive, bytes)));
    case RosPrimitive::Float64:
      return fmt::format("{}", wire_.value(primitive, bytes));
    case RosPrimitive::Uint64:
      return fmt::format("{}", static_cast<std::uint64_t>(wire_.integer(primitive, bytes)));
    case RosPrimitive::Time: {
      const std::int64_t ns = wire_.integer(primitive, bytes), second = 1'000'000'000;
      const std::int64_t whole = ns / second - (ns % second < 0 ? 1 : 0);
      return fmt::format("{}.{:09}", whole, ns - whole * second);
    }
    default:
      return fmt::format("{}", wire_.integer(primitive, bytes));
  }
}

}  // namespace odobench
