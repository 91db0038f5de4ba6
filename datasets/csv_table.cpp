#include "datasets/csv_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

namespace odobench {
namespace {

// Enough of a wrong field to recognise it.
std::string quoted(std::string_view text) {
  return text.size() <= 60 ? fmt::format("\"{}\"", text) : fmt::format("\"{}...\"", text.substr(0, 57));
}

}  // namespace

CsvTable::CsvTable(std::string_view text, const std::string& file, char separator)
    : rest_(text), file_(file), separator_(separator) {
  line_ = 1;
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos)
    fail("found an empty file, expected a header line");
  line_ = 0;
  split(take_line());
  for (std::string_view name : fields_) names_.emplace_back(name);
}

void CsvTable::fail(const std::string& message) const {
  throw DataError(fmt::format("{}:{}: {}", file_, line_, message));
}

std::size_t CsvTable::column(std::string_view name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  if (found == names_.end())
    throw DataError(fmt::format("{}:1: found no column \"{}\", expected it among the {} of the header", file_,
                                name, names_.size()));
  if (std::find(found + 1, names_.end(), name) != names_.end())
    throw DataError(fmt::format("{}:1: found two columns \"{}\", expected one", file_, name));
  return static_cast<std::size_t>(found - names_.begin());
}

std::size_t CsvTable::rows_left_at_most() const {
  const std::size_t end = rest_.find('\n');
  return end == std::string_view::npos
             ? 1
             : static_cast<std::size_t>(std::count(rest_.begin(), rest_.end(), '\n')) + 1;
}

std::string_view CsvTable::take_line() {
  ++line_;
  const std::size_t end = rest_.find('\n');
  std::string_view line = rest_.substr(0, end);
  rest_ = end == std::string_view::npos ? std::string_view() : rest_.substr(end + 1);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

void CsvTable::split(std::string_view line) {
  fields_.clear();
  for (;;) {
    const void* hit = line.empty() ? nullptr : std::memchr(line.data(), separator_, line.size());
    if (hit == nullptr) break;
    const auto length = static_cast<std::size_t>(static_cast<const char*>(hit) - line.data());
    fields_.push_back(line.substr(0, length));
    line.remove_prefix(length + 1);
  }
  fields_.push_back(line);
}

bool CsvTable::next() {
  if (rest_.empty()) return false;
  const char first = rest_.front();
  if ((first == '\n' || first == '\r') && rest_.find_first_not_of("\r\n") == std::string_view::npos)
    return false;
  if (rest_.find('\n') == std::string_view::npos) {  // a number cut in two would pass for another number
    ++line_;
    fail("found the end of the file inside the line, expected a line break");
  }
  split(take_line());
  if (fields_.size() != names_.size())
    fail(fmt::format("found {} fields, expected {} as in the header", fields_.size(), names_.size()));
  return true;
}

double CsvTable::number(std::size_t column) const {
  return number(fields_[column], column);
}

double CsvTable::number(std::string_view text, std::size_t column) const {
  const bool plus = text.size() > 1 && text[0] == '+' && text[1] != '-';  // from_chars takes no plus sign
  const std::string_view digits = plus ? text.substr(1) : text;
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value))
    fail(fmt::format("found {} in column \"{}\", expected a finite number", quoted(text), names_[column]));
  return value;
}

}  // namespace odobench
