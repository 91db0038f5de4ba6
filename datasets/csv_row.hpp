// One row of a separated text with a header, whatever the text comes from; errors carry file and line.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "datasets/error.hpp"

namespace odobench {

// Base of CsvTable (a text in memory) and CsvStream (a file read piece by piece).
class CsvRow {
 public:
  // Position of a column; DataError when the header has none or two of this name.
  std::size_t column(std::string_view name) const;
  std::string_view field(std::size_t column) const { return fields_[column]; }
  std::size_t line() const { return line_; }

  // The field as a finite decimal number (exponents welcome), or DataError.
  double number(std::size_t column) const;
  // The number in `text`, a part of the row's field `column`.
  double number(std::string_view text, std::size_t column) const;
  // Throws DataError "file:line: message".
  [[noreturn]] void fail(const std::string& message) const;
  const std::string& file() const { return file_; }
  const std::string& name(std::size_t column) const { return names_[column]; }
  const std::vector<std::string>& names() const { return names_; }

 protected:
  CsvRow(std::string file, char separator) : file_(std::move(file)), separator_(separator) {}
  ~CsvRow() = default;

  void take_header(std::string_view line);
  // Splits a line without its break. DataError when its number of fields differs from the header's.
  void take_row(std::string_view line);

  std::size_t line_ = 0;

 private:
  void split(std::string_view line);

  std::string file_;
  char separator_;
  std::vector<std::string> names_;
  std::vector<std::string_view> fields_;
};

}  // namespace odobench
