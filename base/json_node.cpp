#include "base/json_node.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/files.hpp"
#include "base/range.hpp"
#include "base/text.hpp"

namespace odobench {
namespace {

using nlohmann::json;

constexpr std::size_t kLongestFound = 160;  // characters of a message about a value

// What was found, short enough for one line.
std::string brief(const json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array()) return fmt::format("an array of {}", value.size());
  return shown(value.dump(-1, ' ', false, json::error_handler_t::replace));
}

// The word NaN, Infinity or -Infinity, which other programs write though JSON has none, whose reading ended
// at `read`; else "".
std::string_view not_a_number_at(std::string_view text, std::size_t read) {
  std::size_t begin = std::min(read, text.size());
  const auto part = [](char c) {
    return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '+';
  };
  while (begin > 0 && part(text[begin - 1])) --begin;
  std::size_t end = begin;
  while (end < text.size() && part(text[end])) ++end;
  const std::string_view word = text.substr(begin, end - begin);
  std::string lower(word);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const char* known : {"nan", "-nan", "infinity", "-infinity", "inf", "-inf", "+inf", "+infinity"})
    if (lower == known) return word;
  return {};
}

std::size_t line_breaks(std::string_view text, std::size_t end) {
  return static_cast<std::size_t>(
      std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(std::min(end, text.size())), '\n'));
}

// Where the number `digits` stands first outside of strings.
std::size_t find_number(std::string_view text, std::string_view digits) {
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"') quoted = !quoted;
    if (quoted && text[i] == '\\') ++i;
    const bool begins =
        i == 0 || std::string_view("0123456789+-.eE").find(text[i - 1]) == std::string_view::npos;
    if (!quoted && begins && text.compare(i, digits.size(), digits) == 0) return i;
  }
  return 0;
}

// "number overflow parsing '1e309'", the only fault of this kind in reading.
std::string too_large(const json::out_of_range& e, std::string_view text, const std::string& file,
                      std::size_t line, const std::string& place) {
  const std::string_view what = e.what();
  const auto open = what.find('\'');
  const std::string_view digits = what.substr(open + 1, what.rfind('\'') - open - 1);
  return fmt::format("{}:{}: {}: found {}, expected a number within the range of a double", file,
                     line + line_breaks(text, find_number(text, digits)), place, shown(digits));
}

std::string broken(const json::parse_error& e, std::string_view text, const std::string& file,
                   std::size_t line, const std::string& place) {
  const std::size_t read = std::min(e.byte > 0 ? e.byte - 1 : 0, text.size());
  line += line_breaks(text, read);
  if (const std::string_view word = not_a_number_at(text, read); !word.empty())
    return fmt::format("{}:{}: {}: found {}, expected a finite number", file, line, place, word);
  // The library's sentence follows its own "[...] parse error at line L, column C: ".
  std::string what = e.what();
  const auto column = what.find("column ");
  const auto sentence = column == std::string::npos ? column : what.find(": ", column);
  if (sentence != std::string::npos) what = what.substr(sentence + 2);
  std::replace(what.begin(), what.end(), '\n', ' ');
  return fmt::format("{}:{}: broken JSON: {}", file, line, what);
}

// Where key number `wanted` (from 1) of a text ends that is correct up to there.
std::size_t end_of_key(std::string_view text, std::size_t wanted) {
  std::vector<bool> in_object;
  bool key_next = false;
  std::size_t keys = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '{' || c == '[') in_object.push_back(c == '{');
    if ((c == '}' || c == ']') && !in_object.empty()) in_object.pop_back();
    if (c == '{' || c == ',') key_next = !in_object.empty() && in_object.back();
    if (c != '"') continue;
    for (++i; i < text.size() && text[i] != '"'; ++i)
      if (text[i] == '\\') ++i;
    if (key_next && ++keys == wanted) return i;
    key_next = false;
  }
  return text.size();
}

// Thrown through the library when the key read last is in its object already.
struct KeyTwice {
  std::string key;
  std::size_t number = 0;  // of the keys of the text, from 1
};

// Builds the document from the library's events, refuses a key that an object has already, and knows where
// the reading is. Not the library's own parser with a callback: that one looks through all elements of an
// array after every object in it, which is quadratic in the number of recordings.
class Reading {
 public:
  explicit Reading(json& root) : root_(root) {}

  bool null() { return value(nullptr); }
  bool boolean(bool v) { return value(v); }
  bool number_integer(json::number_integer_t v) { return value(v); }
  bool number_unsigned(json::number_unsigned_t v) { return value(v); }
  bool number_float(json::number_float_t v, const std::string&) { return value(v); }
  bool string(std::string& v) {
    if (!open_.empty() && !open_.back().is_array && (open_.back().key == "id" || open_.back().key == "name"))
      open_.back().id = v;
    return value(std::move(v));
  }
  bool binary(json::binary_t& v) { return value(std::move(v)); }
  bool start_object(std::size_t) { return start(json::object(), false); }
  bool start_array(std::size_t) { return start(json::array(), true); }
  bool end_object() { return end(); }
  bool end_array() { return end(); }
  bool key(std::string& name) {
    Level& level = open_.back();
    const auto [member, is_new] = level.value->get_ref<json::object_t&>().emplace(name, nullptr);
    level.key = name;
    level.member = &member->second;
    ++keys_;
    if (!is_new) throw KeyTwice{name, keys_};
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const json::exception& error) {
    if (const auto* broken = dynamic_cast<const json::parse_error*>(&error)) throw *broken;
    if (const auto* large = dynamic_cast<const json::out_of_range*>(&error)) throw *large;
    throw error;
  }

  // "/windows/3 (p003)/ax/5": numbers count from 0, the id or name of an element in brackets.
  // Escaped, for messages.
  std::string place() const {
    std::string text;
    for (std::size_t k = 0; k < open_.size(); ++k) {
      text += "/" + (open_[k].is_array ? std::to_string(open_[k].index) : open_[k].key);
      if (k + 1 < open_.size() && !open_[k + 1].id.empty()) text += fmt::format(" ({})", open_[k + 1].id);
    }
    return text.empty() ? "/" : shown(text, kLongestPath);
  }

 private:
  struct Level {
    bool is_array = false;
    std::size_t index = 0;
    std::string key, id;
    json* value = nullptr;
    json* member = nullptr;  // of an object: where the value of `key` goes
  };
  // Into the place that is next. Elements move when their array grows, but none of them is open then.
  json* put(json v) {
    if (open_.empty()) return &(root_ = std::move(v));
    Level& level = open_.back();
    if (!level.is_array) return &(*level.member = std::move(v));
    level.value->push_back(std::move(v));
    return &level.value->back();
  }
  bool value(json v) {
    put(std::move(v));
    next();
    return true;
  }
  bool start(json empty, bool is_array) {
    Level level;
    level.is_array = is_array;
    level.value = put(std::move(empty));
    open_.push_back(std::move(level));
    return true;
  }
  bool end() {
    open_.pop_back();
    next();
    return true;
  }
  void next() {
    if (!open_.empty() && open_.back().is_array) ++open_.back().index;
  }

  json& root_;
  std::vector<Level> open_;
  std::size_t keys_ = 0;
};

// The path to a value of the document: a walk through it, in no recursion, since it may be nested deeply.
std::string path_to(const json* wanted, const json& root) {
  struct Level {
    const json* value;
    json::const_iterator at;
    std::size_t index;
  };
  if (wanted == &root) return "";
  std::vector<Level> open{{&root, root.begin(), 0}};
  while (!open.empty()) {
    Level& level = open.back();
    if (level.at == level.value->end()) {
      open.pop_back();
      if (!open.empty()) ++open.back().at, ++open.back().index;
      continue;
    }
    const json& child = *level.at;
    if (&child == wanted) break;
    if (child.is_structured())
      open.push_back({&child, child.begin(), 0});
    else
      ++level.at, ++level.index;
  }
  std::string path;
  for (const Level& level : open)
    path += "/" + (level.value->is_object() ? level.at.key() : std::to_string(level.index));
  return path;
}

}  // namespace

json parse_json(std::string_view text, const std::string& file, std::size_t line) {
  json root;
  Reading reading(root);
  try {
    json::sax_parse(text, &reading);
    return root;
  } catch (const KeyTwice& e) {
    throw DataError(fmt::format("{}:{}: {}: found the key {} twice in one object, expected once", file,
                                line + line_breaks(text, end_of_key(text, e.number)), reading.place(),
                                brief(json(e.key))));
  } catch (const json::parse_error& e) {
    const std::string message = broken(e, text, file, line, reading.place());
    if (e.byte > text.size()) throw JsonEndsEarly(message);
    throw DataError(message);
  } catch (const json::out_of_range& e) {
    throw DataError(too_large(e, text, file, line, reading.place()));
  } catch (const json::exception& e) {
    throw DataError(fmt::format("{}: broken JSON: {}", file, e.what()));
  }
}

struct JsonNode::Document {
  std::string file;
  std::size_t line = 0;  // 0: the file is the document
  json root;
};

JsonNode::JsonNode(std::shared_ptr<const Document> document, const json* value)
    : document_(std::move(document)), value_(value) {}

JsonNode JsonNode::parse(std::string_view text, const std::filesystem::path& file) {
  auto document = std::make_shared<Document>();
  document->file = file.string();
  document->root = parse_json(text, document->file);
  const json* root = &document->root;
  return {std::move(document), root};
}

JsonNode JsonNode::parse_line(std::string_view text, const std::filesystem::path& file, std::size_t line) {
  auto document = std::make_shared<Document>();
  document->file = file.string();
  document->line = line;
  document->root = parse_json(text, document->file, line);
  const json* root = &document->root;
  return {std::move(document), root};
}

JsonNode JsonNode::read(const std::filesystem::path& file) {
  return parse(read_file(file), file);
}

std::string JsonNode::path() const {
  return path_to(value_, document_->root);
}

void JsonNode::fail(const std::string& found, const std::string& expected) const {
  const std::string place = path();
  throw DataError(fmt::format("{}{}: {}: found {}, expected {}", shown(document_->file, kLongestPath),
                              document_->line > 0 ? fmt::format(":{}", document_->line) : "",
                              place.empty() ? "/" : shown(place, kLongestPath), shown(found, kLongestFound),
                              expected));
}

void JsonNode::fail(const std::string& expected) const {
  fail(brief(*value_), expected);
}

const std::string& JsonNode::file() const {
  return document_->file;
}

char JsonNode::kind() const {
  return value_->is_object() ? '{' : value_->is_array() ? '[' : ' ';
}

bool JsonNode::has(const std::string& key) const {
  return value_->is_object() && value_->contains(key);
}

JsonNode JsonNode::at(const std::string& key) const {
  if (auto member = find(key)) return *member;
  fail(fmt::format("no key \"{}\"", key), "it");
}

std::optional<JsonNode> JsonNode::find(const std::string& key) const {
  if (!value_->is_object()) fail("an object");
  const auto member = value_->find(key);
  if (member == value_->end()) return std::nullopt;
  return JsonNode(document_, &*member);
}

void JsonNode::allow_only(std::initializer_list<std::string_view> allowed) const {
  for (const std::string& key : keys())
    if (std::find(allowed.begin(), allowed.end(), key) == allowed.end())
      fail(fmt::format("unknown key \"{}\"", key), fmt::format("one of {}", fmt::join(allowed, ", ")));
}

std::vector<std::string> JsonNode::keys() const {
  if (!value_->is_object()) fail("an object");
  std::vector<std::string> names;
  for (const auto& item : value_->items()) names.push_back(item.key());
  return names;
}

JsonNode JsonNode::element(std::size_t index) const {
  return {document_, &(*value_)[index]};
}

std::vector<JsonNode> JsonNode::elements() const {
  if (!value_->is_array()) fail("an array");
  std::vector<JsonNode> nodes;
  nodes.reserve(value_->size());
  for (std::size_t i = 0; i < value_->size(); ++i) nodes.push_back(element(i));
  return nodes;
}

std::string JsonNode::text() const {
  if (!value_->is_string()) fail("a text");
  return value_->get<std::string>();
}

std::string JsonNode::text_or_empty(const std::string& key) const {
  return has(key) ? at(key).text() : std::string();
}

bool JsonNode::boolean() const {
  if (!value_->is_boolean()) fail("true or false");
  return value_->get<bool>();
}

double JsonNode::number() const {
  if (!value_->is_number()) fail("a number");
  const auto value = value_->get<double>();
  if (!in_range(value)) fail(fmt::format("a number of at most {:g} in size", kLargestNumber));
  return value;
}

std::int64_t JsonNode::integer() const {
  const bool fits =
      !value_->is_number_unsigned() ||
      value_->get<std::uint64_t>() <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  if (!value_->is_number_integer() || !fits) fail("an integer");
  return value_->get<std::int64_t>();
}

std::int64_t JsonNode::count() const {
  const std::int64_t value = integer();
  if (value < 0) fail("an integer >= 0");
  return value;
}

std::uint64_t JsonNode::unsigned_integer() const {
  // One that is not from a text may be signed and positive.
  const bool negative =
      !value_->is_number_unsigned() && value_->is_number_integer() && value_->get<std::int64_t>() < 0;
  if (!value_->is_number_integer() || negative) fail("an integer >= 0 of 64 bits");
  return value_->get<std::uint64_t>();
}

int JsonNode::small_integer() const {
  const std::int64_t value = integer();
  if (value < std::numeric_limits<int>::min() || value > std::numeric_limits<int>::max())
    fail("an integer of 32 bits");
  return static_cast<int>(value);
}

std::optional<double> JsonNode::optional_number() const {
  if (value_->is_null()) return std::nullopt;
  if (!value_->is_number()) fail("a number");
  return value_->get<double>();
}

double JsonNode::stored_number() const {
  return optional_number().value_or(std::numeric_limits<double>::quiet_NaN());
}

std::vector<double> JsonNode::stored_numbers() const {
  if (!value_->is_array()) fail("an array of numbers");
  std::vector<double> values;
  values.reserve(value_->size());
  for (std::size_t i = 0; i < value_->size(); ++i)
    values.push_back((*value_)[i].is_number() ? (*value_)[i].get<double>() : element(i).stored_number());
  return values;
}

std::vector<double> JsonNode::numbers() const {
  if (!value_->is_array()) fail("an array of numbers");
  std::vector<double> values;
  values.reserve(value_->size());
  for (std::size_t i = 0; i < value_->size(); ++i)
    values.push_back((*value_)[i].is_number() ? (*value_)[i].get<double>() : element(i).number());
  return values;
}

std::vector<std::int64_t> JsonNode::integers() const {
  if (!value_->is_array()) fail("an array of integers");
  std::vector<std::int64_t> values;
  values.reserve(value_->size());
  for (std::size_t i = 0; i < value_->size(); ++i) values.push_back(element(i).integer());
  return values;
}

json finite_or_null(double value) {
  return std::isfinite(value) ? json(value) : json(nullptr);
}

json finite_or_null(const std::optional<double>& value) {
  return value ? finite_or_null(*value) : json(nullptr);
}

}  // namespace odobench
