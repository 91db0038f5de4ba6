// Rows of a separated text file with one header line; errors carry file and line.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/error.hpp"

namespace odobench {

// Walks over the rows of a text that outlives it. A carriage return before the line's end and blank lines at
// the end of the text are ignored; a blank line between rows is a row with one empty field.
class CsvTable {
 public:
  // Reads the header line; no text at all is a DataError. `file` is the name in messages.
  CsvTable(std::string_view text, const std::string& file, char separator);

  // Position of a column; DataError when the header has none or two of this name.
  std::size_t column(std::string_view name) const;
  // To the next row; false at the end. Throws DataError when its number of fields differs from the header's,
  // and when the last line has no line break: the file was cut off.
  bool next();
  std::string_view field(std::size_t column) const { return fields_[column]; }
  std::size_t line() const { return line_; }
  // An upper bound for the number of rows left, to reserve memory.
  std::size_t rows_left_at_most() const;

  // The field as a finite decimal number (exponents welcome), or DataError.
  double number(std::size_t column) const;
  // The number in `text`, a part of the row's field `column`.
  double number(std::string_view text, std::size_t column) const;
  [[noreturn]] void fail(const std::string& message) const;
  const std::string& name(std::size_t column) const { return names_[column]; }

 private:
  std::string_view take_line();
  void split(std::string_view line);

  std::string_view rest_;
  std::string file_;
  char separator_;
  std::size_t line_ = 0;
  std::vector<std::string> names_;
  std::vector<std::string_view> fields_;
};

}  // namespace odobench
