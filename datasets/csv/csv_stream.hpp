// Rows of a separated text file with one header line, read piece by piece: memory does not depend on the
// file's length, and pipes work as well as files.
#pragma once

#include <atomic>
#include <filesystem>

#include "datasets/csv/csv_row.hpp"
#include "datasets/csv/text_lines.hpp"

namespace odobench {

// Same rules as CsvTable: the dialect is found in the header (datasets/csv/csv_dialect.hpp), a carriage
// return before the line's end and blank lines at the end of the file are ignored, a last line without a line
// break must have all fields.
class CsvStream : public CsvRow {
 public:
  // `separator`: where the header has none. Opens the file ("-" is standard input) and reads the header line.
  // Throws DataError when it cannot be read or is empty. Once `interrupt` (may be null) is set, the file ends
  // as soon as the rows already read are used up, also while a pipe delivers nothing (before the header:
  // without columns).
  CsvStream(const std::filesystem::path& file, char separator, const std::atomic<bool>* interrupt = nullptr);

  // To the next row; false at the end. The fields of the row before become invalid.
  bool next();
  // next() said false because of `interrupt`: the rows so far are not all.
  bool interrupted() const { return interrupted_ || lines_.interrupted(); }

 private:
  bool take_line(std::string_view& line) override;

  TextLines lines_;
  const std::atomic<bool>* interrupt_;
  bool interrupted_ = false;
};

}  // namespace odobench
