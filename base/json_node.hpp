// Reading JSON with errors that say where: a value together with its file and path.
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"

namespace odobench {

// The document in a text whose first line is number `line` of the file. DataError "file:line: broken JSON:
// ...", as is a key that occurs twice in one object; NaN, Infinity and numbers beyond the range of a double,
// which other programs write, are "file:line: /path/to/value: found ..., expected ...".
nlohmann::json parse_json(std::string_view text, const std::string& file, std::size_t line = 1);

// A value inside a parsed file. Cheap to copy; copies share the document. Every mismatch is a DataError
// "file: /path/to/value: found ..., expected ...".
class JsonNode {
 public:
  // Parses like parse_json().
  static JsonNode parse(std::string_view text, const std::filesystem::path& file);
  static JsonNode read(const std::filesystem::path& file);

  bool has(const std::string& key) const;
  // The member; missing or not an object: DataError.
  JsonNode at(const std::string& key) const;
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
  // Whole arrays at once; entries must be numbers of any size, or integers.
  std::vector<double> numbers() const;
  std::vector<std::int64_t> integers() const;

  [[noreturn]] void fail(const std::string& found, const std::string& expected) const;
  const std::string& path() const { return path_; }
  const std::string& file() const;

 private:
  struct Document;
  JsonNode(std::shared_ptr<const Document> document, const nlohmann::json* value, std::string path);
  JsonNode element(std::size_t index) const;

  std::shared_ptr<const Document> document_;
  const nlohmann::json* value_;
  std::string path_;
};

}  // namespace odobench
