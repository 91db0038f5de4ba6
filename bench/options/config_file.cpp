#include "bench/options/config_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "base/files.hpp"
#include "base/json_node.hpp"
#include "base/text.hpp"

namespace odobench {
namespace {

using Json = nlohmann::json;

constexpr std::uintmax_t kLargestConfig = 1 << 20;  // bytes

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

[[noreturn]] void refuse(const std::string& where, const std::string& what) {
  throw std::invalid_argument(where + ": " + what);
}

void add(std::vector<ConfigEntry>& entries, ConfigEntry entry) {
  for (const ConfigEntry& e : entries)
    if (e.key == entry.key) refuse(entry.where, fmt::format("'{}' is given twice", shown(entry.key)));
  entries.push_back(std::move(entry));
}

std::string json_scalar(const Json& value, const std::string& where, const std::string& key) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean() || value.is_number()) return value.dump();
  refuse(where, fmt::format("'{}' is {}; expected a text, a number, true, false or an array of these",
                            shown(key), value.type_name()));
}

std::vector<ConfigEntry> from_json(const std::string& path, const std::string& text) {
  Json root;
  try {
    root = parse_json(text, path);
  } catch (const DataError& error) {
    throw std::invalid_argument(error.what());
  }
  std::vector<ConfigEntry> entries;
  for (const auto& [key, value] : root.items()) {
    ConfigEntry entry{key, {}, path};
    if (value.is_array())
      for (const Json& item : value) entry.values.push_back(json_scalar(item, path, key));
    else
      entry.values.push_back(json_scalar(value, path, key));
    if (entry.values.empty())
      refuse(path, fmt::format("'{}' is an empty array; expected a value", shown(key)));
    entries.push_back(std::move(entry));
  }
  return entries;
}

// The part of `text` from `begin` that is one value: quoted, or bare up to one of `stops`. Moves begin behind
// it.
std::string take_value(const std::string& text, std::size_t& begin, const char* stops,
                       const std::string& where) {
  begin = text.find_first_not_of(" \t", begin);
  if (begin == std::string::npos) refuse(where, "a value is missing after '='");
  const char quote = text[begin];
  if (quote == '"' || quote == '\'') {
    const auto end = text.find(quote, begin + 1);
    if (end == std::string::npos)
      refuse(where, fmt::format("no closing {} in '{}'", quote, shown(trimmed(text))));
    const std::string value = text.substr(begin + 1, end - begin - 1);
    begin = end + 1;
    return value;
  }
  const auto end = std::min(text.find_first_of(stops, begin), text.size());
  const std::string value = trimmed(text.substr(begin, end - begin));
  begin = end;
  if (value.empty()) refuse(where, "a value is missing after '='");
  return value;
}

void expect_end(const std::string& text, std::size_t begin, const std::string& where) {
  const std::string rest = begin < text.size() ? trimmed(text.substr(begin)) : "";
  if (!rest.empty() && rest[0] != '#' && rest[0] != ';')
    refuse(where, fmt::format("text after the value: '{}'", shown(rest)));
}

std::vector<std::string> take_values(const std::string& text, const std::string& where) {
  std::size_t begin = text.find_first_not_of(" \t");
  std::vector<std::string> values;
  if (begin == std::string::npos || text[begin] != '[') {
    std::size_t at = 0;
    values.push_back(take_value(text, at, "#;", where));
    expect_end(text, at, where);
    return values;
  }
  for (++begin;;) {
    values.push_back(take_value(text, begin, ",]", where));
    begin = text.find_first_not_of(" \t", begin);
    if (begin == std::string::npos || (text[begin] != ',' && text[begin] != ']'))
      refuse(where, fmt::format("no closing ] in '{}'", shown(trimmed(text))));
    if (text[begin++] == ']') break;
  }
  expect_end(text, begin, where);
  return values;
}

std::vector<ConfigEntry> from_ini(const std::string& path, const std::string& text) {
  std::vector<ConfigEntry> entries;
  std::istringstream in(text);
  std::string raw;
  for (int number = 1; std::getline(in, raw); ++number) {
    const std::string line = trimmed(raw);
    const std::string where = fmt::format("{}:{}", path, number);
    if (line.empty() || line[0] == '#' || line[0] == ';') continue;
    if (line[0] == '[') {
      if (line != "[run]")
        refuse(where, fmt::format("section '{}'; the only one known is [run]", shown(line)));
      continue;
    }
    const auto equals = line.find('=');
    if (equals == std::string::npos || equals == 0)
      refuse(where, fmt::format("'{}'; expected key = value", shown(line)));
    add(entries, {trimmed(line.substr(0, equals)), take_values(line.substr(equals + 1), where), where});
  }
  return entries;
}

}  // namespace

std::vector<ConfigEntry> read_config(const std::string& path) {
  std::string text;
  try {
    text = read_file(path, kLargestConfig);
  } catch (const DataError& e) {  // options are usage
    throw std::invalid_argument(e.what());
  }
  if (text.rfind("\xef\xbb\xbf", 0) == 0) text.erase(0, 3);  // a byte order mark
  const auto first = text.find_first_not_of(" \t\r\n");
  return first != std::string::npos && text[first] == '{' ? from_json(path, text) : from_ini(path, text);
}

}  // namespace odobench
