#include "datasets/logs/ros/messages/json_message.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/json_node.hpp"
#include "datasets/logs/ros/messages/message_path.hpp"

namespace odobench {
namespace {

using nlohmann::json;

constexpr std::size_t kLongestJsonMessage = 1 << 20;
constexpr int kDeepestJsonMessage = 32;
constexpr std::size_t kMostJsonFields = 2000, kMostJsonElements = 16, kLongestJsonText = 200;

json parse_json_message(std::string_view text) {
  if (text.size() > kLongestJsonMessage)
    throw BadMessage(fmt::format("{} bytes of JSON, more than {}", text.size(), kLongestJsonMessage));
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"') quoted = !quoted;
    if (quoted && text[i] == '\\') ++i;
    if (quoted) continue;
    if (text[i] == '{' || text[i] == '[') ++depth;
    if (text[i] == '}' || text[i] == ']') --depth;
    if (depth > kDeepestJsonMessage)
      throw BadMessage(fmt::format("JSON nested deeper than {}", kDeepestJsonMessage));
  }
  try {
    return parse_json(text, "line");
  } catch (const DataError& e) {
    throw BadMessage(e.what());
  }
}

const json* member(const json* value, std::string_view name) {
  if (!value->is_object()) return nullptr;
  const auto found = value->find(name);
  return found == value->end() ? nullptr : &*found;
}

bool equals_text(const json& value, const std::string& text) {
  if (value.is_string()) return value.get_ref<const std::string&>() == text;
  return value.is_primitive() && value.dump() == text;
}

bool is_selected(const json& element, const PathStep& step) {
  for (const PathStep::Selector& selector : step.selectors) {
    const json* value = &element;
    for (const PathStep& key : parse_message_path(selector.key))
      if (value != nullptr) value = member(value, key.name);
    if (value == nullptr || !equals_text(*value, selector.value)) return false;
  }
  return true;
}

// One step down, null where there is nothing. Arrays side by side: "position[name=left]".
const json* follow(const json* parent, const PathStep& step) {
  const json* value = member(parent, step.name);
  if (value == nullptr || !step.in_array()) return value;
  if (!value->is_array()) return nullptr;
  if (step.index) return *step.index < value->size() ? &(*value)[*step.index] : nullptr;
  for (const json& element : *value)
    if (element.is_object() && is_selected(element, step)) return &element;
  const json* names = member(parent, step.selectors.front().key);
  if (names == nullptr || !names->is_array()) return nullptr;
  for (std::size_t i = 0; i < names->size() && i < value->size(); ++i)
    if (equals_text((*names)[i], step.selectors.front().value)) return &(*value)[i];
  return nullptr;
}

const json* follow(const json* value, const std::vector<PathStep>& path) {
  for (const PathStep& step : path) {
    if (value == nullptr) return nullptr;
    value = follow(value, step);
  }
  return value;
}

std::optional<std::int64_t> integer_member(const json& value, std::initializer_list<const char*> names) {
  for (const char* name : names)
    if (const json* found = member(&value, name); found != nullptr && found->is_number_integer())
      return found->get<std::int64_t>();
  return std::nullopt;
}

// Of an object with seconds and nanoseconds.
std::optional<std::int64_t> json_stamp(const json* value) {
  if (value == nullptr || !value->is_object()) return std::nullopt;
  const auto seconds = integer_member(*value, {"sec", "secs"});
  const auto nanoseconds = integer_member(*value, {"nsec", "nanosec", "nsecs"});
  constexpr std::int64_t kMostSeconds = 9'000'000'000;
  if (!seconds || !nanoseconds || std::abs(*seconds) > kMostSeconds || *nanoseconds < 0 ||
      *nanoseconds > 4 * kMostSeconds)
    return std::nullopt;
  return *seconds * 1'000'000'000 + *nanoseconds;
}

class JsonReader : public RowReader {
 public:
  explicit JsonReader(MessageRequest request) : request_(std::move(request)) {
    for (const std::string& path : request_.numbers) numbers_.push_back(parse_message_path(path));
    for (const std::string& path : request_.text) text_.push_back(parse_message_path(path));
    if (!request_.time.empty())
      times_ = {parse_message_path(request_.time)};
    else
      times_ = {parse_message_path("header.stamp"), parse_message_path("timestamp")};
    found_.assign(numbers_.size(), false);
  }

  Rows read(std::string_view message) override {
    document_ = parse_json_message(message);
    row_ = {};
    row_.numbers.assign(numbers_.size(), std::numeric_limits<double>::quiet_NaN());
    row_.text.assign(text_.size(), {});
    for (std::size_t i = 0; i < numbers_.size(); ++i) {
      const json* value = follow(&document_, numbers_[i]);
      if (value == nullptr || !(value->is_number() || value->is_boolean())) continue;
      row_.numbers[i] = value->is_boolean() ? (value->get<bool>() ? 1.0 : 0.0) : value->get<double>();
      found_[i] = true;
      ++row_.present;
    }
    for (std::size_t i = 0; i < text_.size(); ++i) {
      const json* value = follow(&document_, text_[i]);
      if (value == nullptr || !value->is_string()) continue;
      row_.text[i] = value->get_ref<const std::string&>();
      ++row_.present;
    }
    take_time();
    return {&row_, 1};
  }
  bool has_time_path() const override { return true; }
  RosPrimitive time_primitive() const override { return time_; }
  const std::vector<bool>& found() const override { return found_; }

 private:
  void take_time() {
    for (const auto& path : times_) {
      const json* value = follow(&document_, path);
      if (const auto stamp = json_stamp(value)) {
        row_.has_time = true;
        row_.time = *stamp;
        time_ = RosPrimitive::Time;
        return;
      }
      if (request_.time.empty() || value == nullptr || !value->is_number()) continue;
      row_.has_time = true;
      time_ = value->is_number_integer() ? RosPrimitive::Int64 : RosPrimitive::Float64;
      if (value->is_number_integer())
        row_.time = value->get<std::int64_t>();
      else
        row_.time_real = value->get<double>();
    }
  }

  MessageRequest request_;
  std::vector<std::vector<PathStep>> numbers_, text_, times_;
  std::vector<bool> found_;
  RosPrimitive time_ = RosPrimitive::Time;
  json document_;
  MessageRow row_;
};

}  // namespace

std::unique_ptr<RowReader> json_reader(MessageRequest request) {
  return std::make_unique<JsonReader>(std::move(request));
}

std::vector<LogField> json_fields(std::string_view message) {
  const json document = parse_json_message(message);
  std::vector<LogField> fields;
  const std::function<void(const json&, const std::string&)> look = [&](const json& value,
                                                                        const std::string& path) {
    if (fields.size() >= kMostJsonFields) return;
    if (value.is_object()) {
      for (const auto& [name, part] : value.items()) look(part, path.empty() ? name : path + "." + name);
    } else if (value.is_array()) {
      for (std::size_t i = 0; i < std::min(value.size(), kMostJsonElements); ++i)
        look(value[i], fmt::format("{}[{}]", path, i));
    } else if (value.is_string()) {
      fields.push_back({path, "string", value.get_ref<const std::string&>().substr(0, kLongestJsonText)});
    } else if (!value.is_null()) {
      fields.push_back({path, value.is_boolean() ? "bool" : "number", value.dump()});
    }
  };
  look(document, "");
  return fields;
}

}  // namespace odobench
