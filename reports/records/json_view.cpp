#include "reports/records/json_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace odobench {
namespace {

std::string describe(const nlohmann::json& value) {
  switch (value.type()) {
    case nlohmann::json::value_t::null:
      return "null";
    case nlohmann::json::value_t::object:
      return "an object";
    case nlohmann::json::value_t::array:
      return "a list";
    case nlohmann::json::value_t::string:
      return "a string";
    case nlohmann::json::value_t::boolean:
      return "a boolean";
    default:
      return value.dump();
  }
}

}  // namespace

void JsonView::fail(const std::string& expected) const {
  throw std::runtime_error(
      fmt::format("{}: expected {}, found {}", path_.empty() ? "/" : path_, expected, describe(*value_)));
}

JsonView JsonView::child(const nlohmann::json& value, const std::string& key) const {
  return JsonView(value, path_ + "/" + key);
}

std::optional<JsonView> JsonView::find(const std::string& key) const {
  if (!value_->is_object()) fail("an object");
  const auto found = value_->find(key);
  if (found == value_->end()) return std::nullopt;
  return child(*found, key);
}

JsonView JsonView::at(const std::string& key) const {
  if (auto found = find(key)) return *found;
  throw std::runtime_error(fmt::format("{}: missing field '{}'", path_.empty() ? "/" : path_, key));
}

void JsonView::each_item(const std::function<void(const JsonView&)>& visit) const {
  if (!value_->is_array()) fail("a list");
  std::size_t index = 0;
  for (const nlohmann::json& item : *value_) visit(child(item, std::to_string(index++)));
}

void JsonView::each_field(const std::function<void(const std::string&, const JsonView&)>& visit) const {
  if (!value_->is_object()) fail("an object");
  for (const auto& field : value_->items()) visit(field.key(), child(field.value(), field.key()));
}

void JsonView::only_keys(std::initializer_list<const char*> known) const {
  each_field([&](const std::string& key, const JsonView&) {
    if (std::any_of(known.begin(), known.end(), [&](const char* name) { return key == name; })) return;
    throw std::runtime_error(fmt::format("{}: unknown field '{}', expected one of: {}",
                                         path_.empty() ? "/" : path_, key, fmt::join(known, ", ")));
  });
}

bool JsonView::boolean() const {
  if (!value_->is_boolean()) fail("true or false");
  return value_->get<bool>();
}

std::string JsonView::string() const {
  if (!value_->is_string()) fail("a string");
  return value_->get<std::string>();
}

double JsonView::number() const {
  return optional_number().value_or(std::numeric_limits<double>::quiet_NaN());
}

std::optional<double> JsonView::optional_number() const {
  if (value_->is_null()) return std::nullopt;
  if (!value_->is_number()) fail("a number");
  return value_->get<double>();
}

std::int64_t JsonView::integer() const {
  const bool too_large =
      value_->is_number_unsigned() &&
      value_->get<std::uint64_t>() > std::uint64_t{std::numeric_limits<std::int64_t>::max()};
  if (!value_->is_number_integer() || too_large) fail("an integer");
  return value_->get<std::int64_t>();
}

std::int64_t JsonView::count() const {
  const std::int64_t value = integer();
  if (value < 0) fail("an integer >= 0");
  return value;
}

std::uint64_t JsonView::unsigned_integer() const {
  const bool negative =
      value_->is_number_integer() && !value_->is_number_unsigned() && value_->get<std::int64_t>() < 0;
  if (!value_->is_number_integer() || negative) fail("a non-negative integer");
  return value_->get<std::uint64_t>();
}

int JsonView::small_integer() const {
  const std::int64_t value = integer();
  if (value < std::numeric_limits<int>::min() || value > std::numeric_limits<int>::max())
    fail("an integer of 32 bits");
  return static_cast<int>(value);
}

nlohmann::json finite_or_null(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
}
nlohmann::json finite_or_null(const std::optional<double>& value) {
  return value ? finite_or_null(*value) : nlohmann::json(nullptr);
}

std::string complaint(const nlohmann::json::exception& error) {
  std::string text = error.what();
  // "[json.exception.parse_error.101] parse error at line 1, column 5: syntax error while ..."
  if (const auto end = text.find("] "); text.rfind("[json.exception", 0) == 0 && end != std::string::npos)
    text.erase(0, end + 2);
  if (text.rfind("parse error", 0) == 0)
    if (const auto colon = text.find(": "); colon != std::string::npos) text.erase(0, colon + 2);
  return text;
}

}  // namespace odobench
