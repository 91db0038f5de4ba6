// How a table in a text is written: where its rows begin, what stands between the fields, and what they are
// called. Looked for in its first rows; nothing is asked.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/csv/csv_dialect.hpp"
#include "datasets/logs/log_file.hpp"

namespace odobench {

// A field of a source: a column as it is, or what is computed from several.
struct TableField {
  LogField info;
  std::vector<std::size_t> columns;
  // Of the numbers in these columns, in their order; none: the one column's number.
  std::function<double(const double*)> value;
};

struct TableSource {
  std::string name, type = "table";
  std::vector<TableField> fields;
};

struct TableLayout {
  std::string format = "CSV";
  char separator = ',', decimal = '.';
  std::string comment_marks = "#%";
  std::size_t first_row_line = 1;  // number of the line that may be the first row
  std::vector<std::string> names;  // of the columns; "#3" where it has none
  std::vector<TableSource> sources;
  std::size_t time = npos;  // column that tells time; npos: none known
  std::string time_unit;
  std::filesystem::path times_file;  // a line per row; empty: `time` tells them
  std::vector<std::string> notes;    // what was assumed

  static constexpr std::size_t npos = static_cast<std::size_t>(-1);
};

// The first lines of a table: what is looked at.
struct TableHead {
  struct Line {
    std::size_t number;
    std::string text;
  };
  std::vector<Line> comments, lines;  // lines: neither comment nor blank
  char declared = 0;                  // by "sep=;"
  bool latin1 = false;                // header or comments were no UTF-8 and were taken as Latin-1

  std::vector<std::vector<std::string>> rows(char separator) const;
};

// At most 64 lines with something in them, 1 MiB in all. DataError where this is no text (UTF-16, zero
// bytes). `marks`: characters that begin a comment.
TableHead read_table_head(const std::filesystem::path& file, const std::string& marks);

// The fields of a line; quotes are taken away. A quote that is not closed leaves the line in one piece.
std::vector<std::string> table_fields(std::string_view line, char separator);

// The separator among ; tab , | and blanks that gives the same count of fields in the most lines, and of
// these the one whose fields are numbers.
char find_table_separator(const TableHead& head);

// Finds out everything, unless `options` say it. DataError "FILE: ..." where this is no table.
TableLayout find_table_layout(const std::filesystem::path& file, const LogOptions& options);

// A number, empty, or a word that stands for no number: nan, NA, N/A, null, -.
bool number_or_nothing(std::string_view field);
bool stands_for_nothing(std::string_view field);

// The line as UTF-8: Latin-1 becomes UTF-8.
std::string latin1_to_utf8(std::string_view text);

}  // namespace odobench
