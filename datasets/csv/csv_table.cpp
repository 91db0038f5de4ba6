#include "datasets/csv/csv_table.hpp"

#include <algorithm>

namespace odobench {

CsvTable::CsvTable(std::string_view text, const std::string& file, char separator)
    : CsvRow(file, separator), rest_(text) {
  if (take_header()) return;
  line_ = 1;
  fail("found an empty file, expected a header line");
}

CsvTable::CsvTable(std::string_view text, const std::string& file, char separator,
                   std::vector<std::string> names)
    : CsvRow(file, separator), rest_(text) {
  take_names(std::move(names));
}

std::size_t CsvTable::rows_left_at_most() const {
  const std::size_t end = rest_.find('\n');
  return end == std::string_view::npos
             ? 1
             : static_cast<std::size_t>(std::count(rest_.begin(), rest_.end(), '\n')) + 1;
}

bool CsvTable::take_line(std::string_view& line) {
  if (rest_.empty()) return false;
  ++line_;
  const std::size_t end = rest_.find('\n');
  unfinished_ = end == std::string_view::npos;
  line = rest_.substr(0, end);
  rest_ = unfinished_ ? std::string_view() : rest_.substr(end + 1);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return true;
}

bool CsvTable::next() {
  if (take_waiting_row()) return true;
  std::string_view line;
  do {
    if (rest_.find_first_not_of("\r\n") == std::string_view::npos || !take_line(line)) return false;
  } while (!take_row(line));
  return true;
}

}  // namespace odobench
