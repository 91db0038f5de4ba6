// A value inside a JSON document that knows its path, so that every complaint names the place.
// All members throw std::runtime_error "/entries/3/cost: expected a number, found a string".
#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

namespace odobench {

class JsonView {
 public:
  // The document must outlive the view.
  explicit JsonView(const nlohmann::json& value, std::string path = "")
      : value_(&value), path_(std::move(path)) {}

  JsonView at(const std::string& key) const;                   // throws when the field is missing
  std::optional<JsonView> find(const std::string& key) const;  // empty when it is
  void each_item(const std::function<void(const JsonView&)>& visit) const;
  void each_field(const std::function<void(const std::string&, const JsonView&)>& visit) const;
  // Throws on the first key that is not among them, with the list.
  void only_keys(std::initializer_list<const char*> known) const;

  std::string string() const;
  bool boolean() const;
  double number() const;  // null, which is how JSON has to store what is not finite, gives not-a-number
  std::optional<double> optional_number() const;  // null gives none
  std::int64_t integer() const;
  std::int64_t count() const;  // an integer >= 0
  std::uint64_t unsigned_integer() const;
  int small_integer() const;

  bool is_null() const { return value_->is_null(); }
  const std::string& path() const { return path_; }
  [[noreturn]] void fail(const std::string& expected) const;

 private:
  JsonView child(const nlohmann::json& value, const std::string& key) const;
  const nlohmann::json* value_;
  std::string path_;
};

// null unless finite.
nlohmann::json finite_or_null(double value);
nlohmann::json finite_or_null(const std::optional<double>& value);

// The reader's complaint without its prefix and position: "syntax error while parsing value - unexpected
// ...".
std::string complaint(const nlohmann::json::exception& error);

}  // namespace odobench
