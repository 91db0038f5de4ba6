// Rows of a separated text with one header line or none, the whole text in memory.
#pragma once

#include "datasets/csv/csv_row.hpp"

namespace odobench {

// Walks over the rows of a text that outlives it, in whatever dialect its header shows
// (datasets/csv/csv_dialect.hpp). A carriage return before the line's end and blank lines at the end of the
// text are ignored; a blank line between rows is a row with one empty field.
class CsvTable : public CsvRow {
 public:
  // Reads the header line; no text at all is a DataError. `file` is the name in messages.
  CsvTable(std::string_view text, const std::string& file, char separator);

  // A text without a header line, whose columns are these: its first line is a row.
  CsvTable(std::string_view text, const std::string& file, char separator, std::vector<std::string> names);

  // To the next row; false at the end. Throws DataError when its number of fields differs from the header's,
  // and when the last line has neither a line break nor
  // all fields: the file was cut off.
  bool next();
  // An upper bound for the number of rows left, to reserve memory.
  std::size_t rows_left_at_most() const;

 private:
  bool take_line(std::string_view& line) override;

  std::string_view rest_;
};

}  // namespace odobench
