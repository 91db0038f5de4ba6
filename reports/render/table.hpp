// A table as data, and its five renderings. A table knows nothing about what it shows.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/better.hpp"

namespace odobench {

enum class Align { Left, Right };

// How a number is written for people; the machine formats (csv, json) always carry the full double.
enum class Notation {
  Fixed,        // precision = digits after the decimal point
  Significant,  // precision = significant digits, exponent where shorter: 2.11e-09
};

// Empty, text, or a number with an optional difference in brackets and an optional mark: 118.125 (+5.625) U
struct Cell {
  std::string text;             // shown when there is no value; "" then means: nothing to show
  std::optional<double> value;  // may be non-finite: "inf", "nan" (json: null)
  int precision = 6;
  Notation notation = Notation::Fixed;
  std::optional<double> difference;  // to a reference; same notation, signed, in brackets
  std::string mark;                  // short sign after the number, explained in a note
  // What another repetition may change about the number: the spread over repeats, infinity where there was
  // one only of something random; none: it repeats up to rounding (kRepeats of it).
  std::optional<double> noise;
  bool best = false;   // of its column, see mark_best
  bool worse = false;  // than the reference row, see mark_best

  bool empty() const { return text.empty() && !value; }
};

Cell text_cell(std::string text);
Cell fixed_cell(double value, int digits);
Cell significant_cell(double value, int digits);
Cell count_cell(double value);  // no digits after the point

struct Column {
  std::string id;     // stable key for machines: "e_max_x"; heads the csv column together with the unit
  std::string name;   // for people: "e_x,max"
  std::string unit;   // "m"; "" for none
  std::string latex;  // heading in LaTeX, verbatim: "$e_{x,\\max}$"; "" means the escaped name
  std::string group;  // neighbours of one group stay together when a console table is split
  Align align = Align::Right;
  std::string mark_name = "mark";  // what the marks mean: name of their csv column and json key
  Better better = Better::None;
};

// A column of words, or of numbers. Without a name the id serves, its underscores as spaces.
Column text_column(std::string id, std::string name = "", std::string group = "");
Column number_column(std::string id, std::string name = "", std::string unit = "", std::string group = "",
                     std::string latex = "");

// The same column, in which the lowest or highest number is the best one.
Column best_if(Better better, Column column);

// The first column names the row; it is repeated when a wide table is split.
struct Table {
  std::string id;     // stable: "errors.line_x"
  std::string title;  // one line
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows;  // every row has columns.size() cells
  std::vector<std::string> notes;
  std::vector<std::size_t> references = {};  // rows that do not compete for the best value: nominal, a bound
  // Id of a column of sentences: console and md show these, one below the other, and no table; "": a table.
  std::string sentences = {};
  bool key = false;  // of those few that are shown first; the others on demand
};

// Numbers that repeat, relative: what compilers and processors change about them.
inline constexpr double kRepeats = 1e-9;

// In the columns that have a better direction, among the rows that are no references:
//   Cell::best   the lowest (highest) finite number and those that tie with it, if it is better than the
//                reference row (where there is exactly one) and than all others by more than its own noise.
//                What ties: reads the same, or differs by at most that noise; of numbers that differ by
//                rounding only, the least noisy one speaks. Where all tie, nothing is best.
//   Cell::worse  worse than the reference row by more than its noise (rounding where that is unknown), or not
//                finite though that is.
// render() does so itself for the formats that people read.
void mark_best(Table& table);
// "!: worse than nominal." where a cell is, else "".
std::string worse_note(const Table& table);

enum class Format { Console, Markdown, Csv, Json, Latex };

// console, md, csv, json, latex. Throws std::invalid_argument with these names.
Format parse_format(const std::string& name);
std::string to_string(Format format);
// Of a file that holds such a rendering, without the point: txt, md, csv, json, tex.
std::string file_extension(Format format);

struct RenderOptions {
  int width = 100;    // console only: columns of the terminal, 0 for unlimited
  bool bold = false;  // console only: the best values in bold instead of with a star; for terminals
};

// The tables one after the other; ends with a newline, "" for no tables (json: an empty list).
// Throws std::invalid_argument naming table and row when a row has another number of cells than there are
// columns.
std::string render(const std::vector<Table>& tables, Format format, const RenderOptions& options = {});

// The renderers behind it.
//   console  aligned columns; text columns wrap, then the table is split into blocks of columns; the best
//            values have a star, which a line below the first such table explains, or are bold
//   md       GitHub tables, a heading each; the best values are bold
//   csv      RFC 4180 with CRLF. Per table: a line `#table,id,title`, the header, the rows, a line
//            `#note,text` per note; an empty line between tables. A column with differences (marks) is
//            followed by a column for them.
//   json     {"schema_version":1,"tables":[{"id","title","columns":[..],"rows":[{column id:
//            cell},..],"notes":[..]}]}; a cell is null, a string, a number, or {"value","difference","mark
//            name"} when it has more than a value
//   latex    booktabs and siunitx 3 (S columns, \unit), groups of columns under a common heading, differences
//            in brackets in a column of their own; cut into blocks that fit a line of 345 pt and into
//            continued tables that fit a page; the best values are bold; a comment names the packages
std::string render_console(const std::vector<Table>& tables, const RenderOptions& options);
std::string render_markdown(const std::vector<Table>& tables);
std::string render_csv(const std::vector<Table>& tables);
std::string render_json(const std::vector<Table>& tables);
std::string render_latex(const std::vector<Table>& tables);

// RFC 4180: quotes around a field with separators, quotes, line breaks or outer blanks; quotes inside
// doubled.
std::string csv_field(const std::string& text);

// Whether no row has anything in column `c`; the table without it.
bool empty_column(const Table& table, std::size_t c);
void erase_column(Table& table, std::size_t c);

// The cells of the column Table::sentences. Throws std::invalid_argument when there is no such column.
std::vector<std::string> sentences_of(const Table& table);

// A line of a list, "- text", with what Markdown would interpret escaped.
std::string markdown_note(const std::string& note);

}  // namespace odobench
