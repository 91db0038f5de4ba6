// Reading JSON with errors that say where: a value together with its file and path. And what writing needs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"

namespace odobench {

// What broken JSON is when the text ends before its value does: cut off, perhaps.
class JsonEndsEarly : public DataError {
 public:
  using DataError::DataError;
};

// The document in a text whose first line is number `line` of the file. DataError "file:line: broken JSON:
// ..."; a key that occurs twice in one object, NaN, Infinity and numbers beyond the range of a double,
// which other programs write, are "file:line: /path/to/value: found ..., expected ...".
nlohmann::json parse_json(std::string_view text, const std::string& file, std::size_t line = 1);

// A value inside a parsed file. Cheap to make and to copy: copies share the document, and a path is looked
// for when a message needs it. Every mismatch is a DataError "file: /path/to/value: found ..., expected ...",
// in a file of many documents "file:line: /path/to/value: ...".
class JsonNode {
 public:
  // Parses like parse_json().
  static JsonNode parse(std::string_view text, const std::filesystem::path& file);
  static JsonNode read(const std::filesystem::path& file);
  // One document of a file that has many: the one that is its line `line`.
  static JsonNode parse_line(std::string_view text, const std::filesystem::path& file, std::size_t line);

  bool is_object() const { return kind() == '{'; }
  bool is_array() const { return kind() == '['; }
  bool has(const std::string& key) const;
  // The member; missing or not an object: DataError.
  JsonNode at(const std::string& key) const;
  // The member, or nothing when it is absent. Not an object: DataError.
  std::optional<JsonNode> find(const std::string& key) const;
  // Refuses keys other than these.
  void allow_only(std::initializer_list<std::string_view> keys) const;
  std::vector<std::string> keys() const;
  // The elements of an array.
  std::vector<JsonNode> elements() const;

  std::string text() const;
  // The text member, or nothing when it is absent.
  std::string text_or_empty(const std::string& key) const;
  bool boolean() const;
  double number() const;         // of at most kLargestNumber in size
  std::int64_t integer() const;  // written without fraction or exponent, fits in 64 bits
  std::int64_t count() const;    // an integer >= 0
  std::uint64_t unsigned_integer() const;
  int small_integer() const;  // of 32 bits
  // What finite_or_null() wrote: a number of any size; null gives not-a-number, or nothing.
  double stored_number() const;
  std::optional<double> optional_number() const;
  std::vector<double> stored_numbers() const;
  // Whole arrays at once; entries must be numbers of any size, or integers.
  std::vector<double> numbers() const;
  std::vector<std::int64_t> integers() const;

  [[noreturn]] void fail(const std::string& found, const std::string& expected) const;
  [[noreturn]] void fail(const std::string& expected) const;  // found: the value itself
  // "/entries/3/cost", "" for the document itself. Looks through the document.
  std::string path() const;
  const std::string& file() const;

 private:
  char kind() const;  // '{', '[' or ' '
  struct Document;
  JsonNode(std::shared_ptr<const Document> document, const nlohmann::json* value);
  JsonNode element(std::size_t index) const;

  std::shared_ptr<const Document> document_;
  const nlohmann::json* value_;
};

// For writing: JSON has no word for what is not finite, so it becomes null, as does what is absent.
nlohmann::json finite_or_null(double value);
nlohmann::json finite_or_null(const std::optional<double>& value);

}  // namespace odobench
