// One row of a separated text with a header, whatever the text comes from; errors carry file and line.
#pragma once

#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"
#include "datasets/csv/csv_dialect.hpp"

namespace odobench {

// Base of CsvTable (a text in memory) and CsvStream (a file read piece by piece).
class CsvRow {
 public:
  // Position of a column; DataError when the header has none or two of this name.
  std::size_t column(std::string_view name) const;
  std::string_view field(std::size_t column) const { return fields_[column]; }
  std::size_t line() const { return line_; }

  // The field as a decimal number of at most kLargestNumber in size (exponents welcome), or DataError.
  double number(std::size_t column) const;
  // The number in `text`, a part of the row's field `column`.
  double number(std::string_view text, std::size_t column) const;
  // Throws DataError "file:line: message".
  [[noreturn]] void fail(const std::string& message) const { fail_at(line_, message); }
  [[noreturn]] void fail_at(std::size_t line, const std::string& message) const;
  const std::string& file() const { return file_; }
  const std::string& name(std::size_t column) const { return names_[column]; }
  const std::vector<std::string>& names() const { return names_; }
  std::size_t header_line() const { return header_line_; }
  // The last line read had no line break.
  bool unfinished() const { return unfinished_; }
  const CsvDialect& dialect() const { return dialect_; }
  // How the file was read, for messages about columns that are missing: "; read as separated by ';', decimal
  // comma".
  std::string reading() const;

 protected:
  // `usual`: the separator where the header has none.
  CsvRow(std::string file, char usual) : file_(std::move(file)) { dialect_.separator = usual; }
  virtual ~CsvRow() = default;

  // The next line without its break; false at the end. Sets unfinished_ for a last line without a break.
  virtual bool take_line(std::string_view& line) = 0;

  // Passes over a byte order mark, "sep=", comments and blank lines, and takes the header; false where there
  // is none.
  bool take_header();
  // Names for the columns of a text that has no header line.
  void take_names(std::vector<std::string> names);
  // Takes the row of this line; false where it is a comment. DataError when its number of fields differs from
  // the header's.
  bool take_row(std::string_view line);
  // The row that take_header() had to read, if any.
  bool take_waiting_row();

  std::size_t line_ = 0;
  bool unfinished_ = false;

 private:
  enum class Decimal { Unknown, Point, Comma };
  void split(std::string_view line);
  bool names_from_comment(const std::string& comment, std::string_view line);
  void refuse_encoding(std::string_view line);
  void check_fields();

  std::string file_;
  CsvDialect dialect_;
  mutable Decimal decimal_ = Decimal::Unknown;  // what the numbers so far were written with
  std::size_t header_line_ = 1;                 // 0: there is none
  std::vector<std::string> names_;
  std::vector<std::string_view> fields_;
  std::deque<std::string> unescaped_;
  std::string waiting_;
  bool has_waiting_ = false;
};

}  // namespace odobench
