#include "datasets/csv_row.hpp"

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

void CsvRow::fail(const std::string& message) const {
  throw DataError(fmt::format("{}:{}: {}", file_, line_, message));
}

std::size_t CsvRow::column(std::string_view name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  if (found == names_.end())
    throw DataError(fmt::format("{}:1: found no column \"{}\", expected it among the {} of the header", file_,
                                name, names_.size()));
  if (std::find(found + 1, names_.end(), name) != names_.end())
    throw DataError(fmt::format("{}:1: found two columns \"{}\", expected one", file_, name));
  return static_cast<std::size_t>(found - names_.begin());
}

void CsvRow::take_header(std::string_view line) {
  split(line);
  for (std::string_view name : fields_) names_.emplace_back(name);
}

void CsvRow::take_row(std::string_view line) {
  split(line);
  if (fields_.size() != names_.size())
    fail(fmt::format("found {} fields, expected {} as in the header", fields_.size(), names_.size()));
}

void CsvRow::split(std::string_view line) {
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

double CsvRow::number(std::size_t column) const {
  return number(fields_[column], column);
}

double CsvRow::number(std::string_view text, std::size_t column) const {
  const bool plus = text.size() > 1 && text[0] == '+' && text[1] != '-';  // from_chars takes no plus sign
  const std::string_view digits = plus ? text.substr(1) : text;
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value))
    fail(fmt::format("found {} in column \"{}\", expected a finite number", quoted(text), names_[column]));
  return value;
}

}  // namespace odobench
