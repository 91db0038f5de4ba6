#include "datasets/csv/csv_row.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/range.hpp"
#include "base/text.hpp"
#include "datasets/csv/decimal_number.hpp"

namespace odobench {
namespace {

// Enough of a wrong field to recognise it.
std::string in_quotes(std::string_view text) {
  return fmt::format("\"{}\"", shown(text));
}

}  // namespace

void CsvRow::fail_at(std::size_t line, const std::string& message) const {
  throw DataError(fmt::format("{}:{}: {}", file_, line, message));
}

std::size_t CsvRow::column(std::string_view name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  if (found == names_.end())
    throw DataError(fmt::format("{}:{}: found no column \"{}\", expected it among the {} of the header{}",
                                file_, header_line_, name, names_.size(), reading()));
  if (std::find(found + 1, names_.end(), name) != names_.end())
    throw DataError(fmt::format("{}:{}: found two columns \"{}\", expected one", file_, header_line_, name));
  return static_cast<std::size_t>(found - names_.begin());
}

std::string CsvRow::reading() const {
  if (names_.size() == 1)
    return fmt::format(" (read as one column, {}; separators known are , ; tab and blanks)",
                       in_quotes(names_.front()));
  return fmt::format(" (read as {}{}{})", dialect_.text(),
                     decimal_ == Decimal::Comma ? ", decimal comma" : "",
                     dialect_.comment_header ? ", header in a comment" : "");
}

void CsvRow::refuse_encoding(std::string_view line) {
  const std::string fault = encoding_fault(line);
  if (!fault.empty()) fail(fault);
}

bool CsvRow::take_header() {
  std::string comment;
  std::size_t comment_at = 0;
  std::string_view line, content;
  for (bool first = true; take_line(line); first = false) {
    if (first && line.substr(0, 3) == "\xEF\xBB\xBF") line.remove_prefix(3);
    refuse_encoding(line);
    if (first && separator_line(line, dialect_.separator)) {
      dialect_.declared = true;
    } else if (line.find_first_not_of(" \t") == std::string_view::npos) {
      continue;
    } else if (comment_line(line, content)) {
      comment = content;
      comment_at = line_;
    } else {
      if (unfinished_) fail("found the end of the file inside the line, expected a line break");
      if (names_from_comment(comment, line)) {
        header_line_ = comment_at;
        return true;
      }
      if (!dialect_.declared) dialect_.separator = find_separator(line, dialect_.separator);
      split(line);
      for (std::string_view name : fields_) names_.emplace_back(name);
      header_line_ = line_;
      return true;
    }
  }
  return false;
}

// "# time,x" above rows of numbers is their header.
bool CsvRow::names_from_comment(const std::string& comment, std::string_view line) {
  if (comment.empty()) return false;
  const char before = dialect_.separator;
  if (!dialect_.declared) dialect_.separator = find_separator(comment, before);
  split(line);
  const std::size_t count = fields_.size();
  const bool numbers = std::all_of(fields_.begin(), fields_.end(), looks_like_number);
  split(comment);
  if (!numbers || count != fields_.size()) {
    dialect_.separator = before;
    return false;
  }
  for (std::string_view name : fields_) names_.emplace_back(name);
  dialect_.comment_header = true;
  waiting_ = line;
  has_waiting_ = true;
  return true;
}

void CsvRow::take_names(std::vector<std::string> names) {
  names_ = std::move(names);
  header_line_ = 0;
}

bool CsvRow::take_waiting_row() {
  if (!has_waiting_) return false;
  has_waiting_ = false;
  return take_row(waiting_);
}

bool CsvRow::take_row(std::string_view line) {
  std::string_view content;
  if (comment_line(line, content)) return false;
  split(line);
  // A separator behind the last field, as some loggers write it.
  if (fields_.size() == names_.size() + 1 && fields_.back().empty()) fields_.pop_back();
  check_fields();
  return true;
}

void CsvRow::check_fields() {
  if (fields_.size() == names_.size() && !(unfinished_ && fields_.back().empty())) return;
  if (unfinished_)  // a number cut in two would pass for another number
    fail("found the end of the file inside the line, expected a line break");
  if (header_line_ == 0)
    fail(fmt::format("found {} fields, expected {}: {}", fields_.size(), names_.size(),
                     fmt::join(names_, ", ")));
  const bool commas = dialect_.separator == ',' && fields_.size() > names_.size();
  fail(fmt::format("found {} fields, expected {} as in the header{}", fields_.size(), names_.size(),
                   commas ? "; numbers with decimal commas need another separator, such as ';'" : ""));
}

void CsvRow::split(std::string_view line) {
  if (!split_fields(line, dialect_.separator, fields_, unescaped_))
    fail("found a quote that is not closed, or text behind one, expected \"...\" around the whole field");
}

double CsvRow::number(std::size_t column) const {
  return number(fields_[column], column);
}

double CsvRow::number(std::string_view text, std::size_t column) const {
  const bool comma = dialect_.separator != ',' && text.find(',') != std::string_view::npos &&
                     text.find('.') == std::string_view::npos;
  const bool has_point = !comma && text.find('.') != std::string_view::npos;
  const Decimal now = comma ? Decimal::Comma : has_point ? Decimal::Point : Decimal::Unknown;
  const std::optional<double> number = decimal_number(text, comma ? ',' : '.');
  if (!number || !std::isfinite(*number))
    fail(fmt::format("found {} in column {}, expected a finite number", in_quotes(text),
                     in_quotes(names_[column])));
  const double value = *number;
  if (!in_range(value))
    fail(fmt::format("found {} in column {}, expected a number of at most {:g} in size", in_quotes(text),
                     in_quotes(names_[column]), kLargestNumber));
  if (now != Decimal::Unknown && decimal_ != Decimal::Unknown && now != decimal_)
    fail(fmt::format("found {} in column {}, expected a decimal {} as in the numbers before it",
                     in_quotes(text), in_quotes(names_[column]),
                     decimal_ == Decimal::Comma ? "comma" : "point"));
  if (now != Decimal::Unknown) decimal_ = now;
  return value;
}

}  // namespace odobench
