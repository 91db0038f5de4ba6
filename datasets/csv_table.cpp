#include "datasets/csv_table.hpp"

#include <algorithm>

namespace odobench {

CsvTable::CsvTable(std::string_view text, const std::string& file, char separator)
    : CsvRow(file, separator), rest_(text) {
  line_ = 1;
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos)
    fail("found an empty file, expected a header line");
  line_ = 0;
  take_header(take_line());
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

bool CsvTable::next() {
  if (rest_.empty()) return false;
  const char first = rest_.front();
  if ((first == '\n' || first == '\r') && rest_.find_first_not_of("\r\n") == std::string_view::npos)
    return false;
  if (rest_.find('\n') == std::string_view::npos) {  // a number cut in two would pass for another number
    ++line_;
    fail("found the end of the file inside the line, expected a line break");
  }
  take_row(take_line());
  return true;
}

}  // namespace odobench
