#include "datasets/logs/tables/table_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/files.hpp"
#include "base/range.hpp"
#include "base/text.hpp"
#include "datasets/csv/decimal_number.hpp"

namespace odobench {

TableRows::TableRows(const std::filesystem::path& file, const TableLayout& layout,
                     std::vector<std::size_t> wanted, bool keep_cut, const Stop& stop)
    : lines_(file, stop.flag()),
      layout_(layout),
      wanted_(std::move(wanted)),
      keep_cut_(keep_cut),
      fields_(wanted_.size()),
      shown_name_(shown_path(file)) {}

void TableRows::fail(const std::string& message) const {
  throw DataError(fmt::format("{}:{}: {}", shown_name_, lines_.line(), message));
}

void TableRows::fail_field(std::size_t k, const std::string& message) const {
  const std::size_t column = wanted_[k];
  fail(fmt::format("field {} '{}': '{}' {}", column + 1, shown(layout_.names[column]), shown(fields_[k]),
                   message));
}

bool TableRows::next() {
  std::string_view line;
  while (lines_.next(line)) {
    if (lines_.line() < layout_.first_row_line) continue;
    if (lines_.line() == 1 && line.substr(0, 3) == "\xEF\xBB\xBF") line.remove_prefix(3);
    const std::size_t begin = line.find_first_not_of(" \t");
    if (begin == std::string_view::npos) continue;
    if (layout_.comment_marks.find(line[begin]) != std::string::npos) continue;
    return split(line);
  }
  if (lines_.interrupted()) throw Interruption();
  return false;
}

// Puts the wanted fields where they belong and looks whether the row is whole.
bool TableRows::split(std::string_view line) {
  const std::size_t expected = layout_.names.size();
  open_end_ = false;
  std::size_t count = 0;
  if (std::memchr(line.data(), '"', line.size()) != nullptr)
    count = split_quoted(line);
  else
    count = layout_.separator == ' ' ? split_blanks(line) : split_plain(line);
  if (count == expected + 1 && open_end_) count = expected;  // "1,2,3,"
  if (count == expected) return true;
  if (lines_.unfinished() && keep_cut_) {
    cut_ = true;
    return false;
  }
  if (lines_.unfinished())
    fail("found the end of the file inside the line, expected a line break: the file is cut off");
  fail(fmt::format("found {} field{}, expected {}{}", count, count == 1 ? "" : "s", expected,
                   count > expected && layout_.separator == ','
                       ? "; numbers with decimal commas need another separator, such as ';'"
                       : ""));
}

std::size_t TableRows::split_plain(std::string_view line) {
  const char separator = layout_.separator;
  const char* at = line.data();
  const char* const end = at + line.size();
  std::size_t column = 0, k = 0;
  open_end_ = line.back() == separator;
  while (k < wanted_.size()) {
    const char* stop = at;
    while (stop != end && *stop != separator) ++stop;
    if (column == wanted_[k]) fields_[k++] = without_blanks({at, static_cast<std::size_t>(stop - at)});
    if (stop == end) {
      for (; k < wanted_.size(); ++k) fields_[k] = {};
      return column + 1;
    }
    at = stop + 1;
    ++column;
  }
  return column + 1 + static_cast<std::size_t>(std::count(at, end, separator));  // the rest is only counted
}

std::size_t TableRows::split_blanks(std::string_view line) {
  const auto blank = [](char c) { return c == ' ' || c == '\t'; };
  const char* at = line.data();
  const char* const end = at + line.size();
  std::size_t column = 0, k = 0;
  for (;; ++column) {
    while (at != end && blank(*at)) ++at;
    if (at == end) break;
    const char* stop = at;
    while (stop != end && !blank(*stop)) ++stop;
    if (k < wanted_.size() && column == wanted_[k]) fields_[k++] = {at, static_cast<std::size_t>(stop - at)};
    at = stop;
  }
  for (; k < wanted_.size(); ++k) fields_[k] = {};
  return column;
}

std::size_t TableRows::split_quoted(std::string_view line) {
  if (!split_fields(line, layout_.separator, all_, unescaped_)) {
    if (lines_.unfinished()) return 0;
    fail("found a quote that is not closed, or text behind one, expected \"...\" around the whole field");
  }
  for (std::size_t k = 0; k < wanted_.size(); ++k)
    fields_[k] = wanted_[k] < all_.size() ? all_[wanted_[k]] : std::string_view();
  open_end_ = all_.back().empty();
  return all_.size();
}

double TableRows::number(std::size_t k) const {
  const std::string_view text = fields_[k];
  if (text.empty()) return std::numeric_limits<double>::quiet_NaN();
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc() && end == text.data() + text.size() && in_range(value) && layout_.decimal == '.')
    return value;
  return unusual_number(k);
}

double TableRows::unusual_number(std::size_t k) const {
  const std::string_view text = fields_[k];
  if (stands_for_nothing(text)) return std::numeric_limits<double>::quiet_NaN();
  if (text == "true" || text == "True" || text == "TRUE") return 1;
  if (text == "false" || text == "False" || text == "FALSE") return 0;
  const char other = layout_.decimal == ',' ? '.' : ',';
  const auto of_kind = [](char point) { return point == ',' ? "comma" : "point"; };
  const std::optional<double> value = decimal_number(text, layout_.decimal);
  if (!value && decimal_number(text, other))
    fail_field(k, fmt::format("is no number with decimal {}: decimal {}? give \"decimal\": \"{}\"",
                              of_kind(layout_.decimal), of_kind(other), other));
  if (!value) fail_field(k, "is no number");
  if (!in_range(*value))
    fail_field(k, fmt::format("is no finite number of at most {:g} in size", kLargestNumber));
  return *value;
}

}  // namespace odobench
