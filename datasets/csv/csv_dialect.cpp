#include "datasets/csv/csv_dialect.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace odobench {
namespace {

// Takes a quoted field off `rest`, which begins with a quote; false where it is not closed.
bool take_quoted(std::string_view& rest, std::string_view& field, std::deque<std::string>& unescaped) {
  std::size_t end = 1;
  bool doubled = false;
  for (;; ++end) {
    end = rest.find('"', end);
    if (end == std::string_view::npos) return false;
    if (end + 1 >= rest.size() || rest[end + 1] != '"') break;
    doubled = true;
    ++end;
  }
  field = rest.substr(1, end - 1);
  rest.remove_prefix(end + 1);
  if (!doubled) return true;
  std::string plain;
  for (std::size_t i = 0; i < field.size(); ++i) {
    plain += field[i];
    if (field[i] == '"') ++i;
  }
  unescaped.push_back(std::move(plain));
  field = unescaped.back();
  return true;
}

// Where the field that `rest` begins with ends.
std::size_t next_separator(std::string_view rest, char separator) {
  if (separator == ' ') return std::min(rest.find_first_of(" \t"), rest.size());
  const void* hit = rest.empty() ? nullptr : std::memchr(rest.data(), separator, rest.size());
  return hit == nullptr ? rest.size() : static_cast<std::size_t>(static_cast<const char*>(hit) - rest.data());
}

// Blanks before a field; a tab is none where it separates.
void skip_blanks(std::string_view& rest, char separator) {
  while (!rest.empty() && (rest.front() == ' ' || (rest.front() == '\t' && separator != '\t')))
    rest.remove_prefix(1);
}

}  // namespace

std::string_view without_blanks(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

std::string CsvDialect::text() const {
  if (separator == '\t') return "separated by tabs";
  if (separator == ' ') return "separated by blanks";
  return fmt::format("separated by '{}'", separator);
}

char find_separator(std::string_view header, char usual) {
  constexpr std::string_view candidates = ";\t,";
  std::size_t counts[3] = {}, blanks = 0;
  bool quoted = false;
  for (const char c : without_blanks(header)) {
    if (c == '"') quoted = !quoted;
    if (quoted) continue;
    const std::size_t at = candidates.find(c);
    if (at != std::string_view::npos) ++counts[at];
    blanks += c == ' ' ? 1 : 0;
  }
  const std::size_t most = static_cast<std::size_t>(std::max_element(counts, counts + 3) - counts);
  if (counts[most] > 0) return candidates[most];
  return blanks > 0 ? ' ' : usual;
}

bool separator_line(std::string_view line, char& separator) {
  if (line.size() >= 2 && line.front() == '"' && line.back() == '"') line = line.substr(1, line.size() - 2);
  if (line.size() < 4 || line.size() > 5) return false;
  for (std::size_t i = 0; i < 3; ++i)
    if ((line[i] | 0x20) != "sep"[i]) return false;
  if (line[3] != '=') return false;
  if (line.size() == 5) separator = line[4];
  return true;
}

bool comment_line(std::string_view line, std::string_view& content) {
  line = without_blanks(line);
  if (line.empty() || (line.front() != '#' && line.front() != '%')) return false;
  content = without_blanks(line.substr(std::min(line.find_first_not_of("#%"), line.size())));
  return true;
}

std::string encoding_fault(std::string_view line) {
  const std::string_view mark = line.substr(0, 2);
  if (mark == "\xFF\xFE" || mark == "\xFE\xFF")
    return "found text in UTF-16, expected UTF-8 (spreadsheets: save as \"CSV UTF-8\")";
  if (line.find('\0') != std::string_view::npos) return "found a byte of zero, expected a text";
  if (line.find('\r') != std::string_view::npos)
    return "found a carriage return inside the line, expected line breaks (LF or CRLF)";
  return "";
}

bool looks_like_number(std::string_view field) {
  if (field.empty() || field.find_first_of("0123456789") == std::string_view::npos) return false;
  if (field.find_first_not_of("0123456789+-.,eE") != std::string_view::npos) return false;
  return field.front() != 'e' && field.front() != 'E';
}

bool split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields,
                  std::deque<std::string>& unescaped) {
  fields.clear();
  unescaped.clear();
  if (separator == ' ') line = without_blanks(line);
  for (;;) {
    std::string_view rest = line, field;
    skip_blanks(rest, separator);
    if (!rest.empty() && rest.front() == '"') {
      if (!take_quoted(rest, field, unescaped)) return false;
      const std::size_t end = next_separator(rest, separator);
      if (!without_blanks(rest.substr(0, end)).empty()) return false;  // text behind the closing quote
      line = rest;
    } else {
      field = without_blanks(rest.substr(0, next_separator(rest, separator)));
      line = rest;
    }
    fields.push_back(field);
    const std::size_t end = next_separator(line, separator);
    if (end == line.size()) return true;
    line.remove_prefix(end + 1);
  }
}

}  // namespace odobench
