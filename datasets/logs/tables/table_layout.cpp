#include "datasets/logs/tables/table_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>

#include "base/files.hpp"
#include "base/text.hpp"
#include "datasets/logs/log_names.hpp"
#include "datasets/logs/log_time.hpp"

namespace odobench {
namespace {

using Row = std::vector<std::string>;
constexpr std::size_t kMostHeaderRows = 10;

char separator_of_option(const std::string& text) {
  if (text == "tab" || text == "\\t") return '\t';
  if (text == "blank" || text == "blanks" || text == "space") return ' ';
  if (text.size() != 1)
    throw std::invalid_argument(
        fmt::format("separator: found '{}', expected one character, tab or blanks", shown(text)));
  return text[0];
}

char decimal_of_option(const std::string& text) {
  if (text == "." || text == ",") return text[0];
  throw std::invalid_argument(fmt::format("decimal: found '{}', expected '.' or ','", shown(text)));
}

// The most frequent count of fields.
std::size_t usual_count(const std::vector<Row>& rows) {
  std::map<std::size_t, std::size_t> counts;
  for (const Row& row : rows) ++counts[row.size()];
  std::size_t best = 0, times = 0;
  for (const auto& [count, n] : counts)
    if (n >= times) {
      best = count;
      times = n;
    }
  return best;
}

// Columns that hold numbers in most rows of the later half.
std::vector<bool> numeric_columns(const std::vector<Row>& rows, std::size_t count) {
  std::vector<std::size_t> numbers(count), words(count);
  for (std::size_t i = rows.size() / 2; i < rows.size(); ++i)
    for (std::size_t c = 0; c < std::min(count, rows[i].size()); ++c) {
      if (stands_for_nothing(rows[i][c])) continue;
      ++(looks_like_number(rows[i][c]) ? numbers : words)[c];
    }
  std::vector<bool> numeric(count);
  for (std::size_t c = 0; c < count; ++c) numeric[c] = numbers[c] > words[c];
  return numeric;
}

// How many of the first rows are no data. A second header row has no number at all.
std::size_t count_header_rows(const std::vector<Row>& rows, std::size_t count) {
  const std::vector<bool> numeric = numeric_columns(rows, count);
  const bool any_numeric = std::any_of(numeric.begin(), numeric.end(), [](bool b) { return b; });
  std::size_t header = 0;
  for (; header < std::min(rows.size(), kMostHeaderRows); ++header) {
    const Row& row = rows[header];
    bool word = !any_numeric && header == 0, number = false;
    for (std::size_t c = 0; c < std::min(count, row.size()); ++c) {
      word = word || (numeric[c] && !number_or_nothing(row[c]));
      number = number || looks_like_number(row[c]);
    }
    if (!word || (header > 0 && (number || row.size() < count))) break;
  }
  return header;
}

bool is_unit_word(std::string_view text) {
  static const std::set<std::string, std::less<>> known{
      "s",   "ms",  "us",  "ns",    "sec", "seconds", "m",     "mm",    "cm",     "rad",     "deg",
      "rpm", "m/s", "1/s", "1/min", "Hz",  "rad/s",   "deg/s", "count", "counts", "degrees", "m/s^2"};
  return known.count(text) > 0;
}

// "[ms]", "(ms)" or "ms": ms; else "".
std::string unit_of_cell(const std::string& cell) {
  if (cell.size() > 2 &&
      ((cell.front() == '[' && cell.back() == ']') || (cell.front() == '(' && cell.back() == ')')))
    return cell.substr(1, cell.size() - 2);
  return is_unit_word(cell) ? cell : "";
}

// Names of the columns from the header's rows, one below the other; a last row of units goes into brackets.
std::vector<std::string> names_of_rows(const std::vector<Row>& header, std::size_t count) {
  bool units = header.size() > 1;
  if (units)
    for (const std::string& cell : header.back())
      units = units && (cell.empty() || cell == "-" || !unit_of_cell(cell).empty());
  std::vector<std::string> names(count);
  for (std::size_t r = 0; r < header.size(); ++r)
    for (std::size_t c = 0; c < std::min(count, header[r].size()); ++c) {
      const std::string& cell = header[r][c];
      if (cell.empty()) continue;
      if (units && r + 1 == header.size()) {
        if (!unit_of_cell(cell).empty()) names[c] += fmt::format(" [{}]", unit_of_cell(cell));
      } else {
        names[c] += (names[c].empty() ? "" : ".") + cell;
      }
    }
  return names;
}

void fill_names(std::vector<std::string>& names) {
  std::set<std::string> seen;
  for (std::size_t c = 0; c < names.size(); ++c)
    if (names[c].empty() || !seen.insert(names[c]).second) names[c] = fmt::format("#{}", c + 1);
}

// The names in a comment above rows without a header: "# timestamp tx ty".
std::vector<std::string> names_of_comment(const TableHead& head, char separator, std::size_t count) {
  if (head.comments.empty()) return {};
  for (const char with : {separator, ',', ' '}) {
    const Row names = table_fields(head.comments.back().text, with);
    if (names.size() == count && std::none_of(names.begin(), names.end(), looks_like_number)) return names;
  }
  return {};
}

bool has_decimal_comma(const std::vector<Row>& rows) {
  bool comma = false;
  for (const Row& row : rows)
    for (const std::string& field : row) {
      if (!looks_like_number(field)) continue;
      if (field.find('.') != std::string::npos) return false;
      comma = comma || field.find(',') != std::string::npos;
    }
  return comma;
}

std::vector<std::string> sample_of(const std::vector<Row>& rows, std::size_t column) {
  std::vector<std::string> values;
  for (const Row& row : rows)
    if (column < row.size() && !stands_for_nothing(row[column])) values.push_back(row[column]);
  return values;
}

// First a column whose name tells time, else the first one whose values do.
void find_time(TableLayout& layout, const std::vector<Row>& rows) {
  for (const bool named : {true, false})
    for (std::size_t c = 0; c < layout.names.size(); ++c) {
      if (named && !name_tells_time(layout.names[c])) continue;
      const std::vector<std::string> values = sample_of(rows, c);
      std::string unit = named ? time_unit_of_name(layout.names[c]) : "";
      const auto numbers = std::count_if(values.begin(), values.end(), looks_like_number);
      if (unit.empty() || 2 * static_cast<std::size_t>(numbers) < values.size())
        unit = time_unit_of_values(values);
      if (unit.empty()) continue;
      layout.time = c;
      layout.time_unit = unit;
      if (time_unit_of_name(layout.names[c]) != unit)
        layout.notes.push_back(
            fmt::format("time: column '{}' taken as {}", layout.names[c], TimeUnit(unit).text()));
      return;
    }
}

void require_columns(const TableLayout& layout, const std::filesystem::path& file) {
  if (layout.names.size() > kMostColumns)
    throw DataError(fmt::format("{}: found {} columns, expected at most {}", shown_path(file),
                                layout.names.size(), kMostColumns));
}

// The rows of data in the head; takes what is above them into `header`.
std::vector<Row> split_head(const TableHead& head, const LogOptions& options, TableLayout& layout,
                            std::vector<Row>& header) {
  std::vector<Row> rows = head.rows(layout.separator);
  std::size_t count = usual_count(rows), above = 0, titles = 0;
  // A separator behind the last field of every row.
  const auto open_end = [&](const Row& row) { return row.size() != count || row.back().empty(); };
  if (count > 1 && rows.front().size() == count - 1 && std::all_of(rows.begin() + 1, rows.end(), open_end))
    --count;
  if (options.header_rows) {
    above = std::min(static_cast<std::size_t>(std::max(0, *options.header_rows)), rows.size());
  } else {
    while (titles < rows.size() && count > 1 && rows[titles].size() != count && titles < kMostHeaderRows)
      ++titles;  // lines of text above the table
    const std::vector<Row> table(rows.begin() + static_cast<std::ptrdiff_t>(titles), rows.end());
    above = titles + count_header_rows(table, count);
  }
  for (std::size_t r = titles; r < above; ++r)
    if (rows[r].size() == count || titles == 0) header.push_back(rows[r]);
  layout.first_row_line = above < rows.size() ? head.lines[above].number : head.lines.back().number + 1;
  layout.names.assign(count, "");
  rows.erase(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(above));
  return rows;
}

}  // namespace

TableLayout find_table_layout(const std::filesystem::path& file, const LogOptions& options) {
  if (!options.encoding.empty() && options.encoding != "utf-8" && options.encoding != "latin-1")
    throw std::invalid_argument(
        fmt::format("encoding: found '{}', expected utf-8 or latin-1", shown(options.encoding)));
  TableLayout layout;
  if (!options.comment.empty()) layout.comment_marks = options.comment;
  const TableHead head = read_table_head(file, layout.comment_marks);
  if (head.lines.empty())
    throw DataError(fmt::format("{}: found no line with a row, expected a table", shown_path(file)));
  layout.separator =
      options.separator.empty() ? find_table_separator(head) : separator_of_option(options.separator);
  std::vector<Row> header;
  const std::vector<Row> rows = split_head(head, options, layout, header);
  const std::size_t count = layout.names.size();
  require_columns(layout, file);
  if (!header.empty()) layout.names = names_of_rows(header, count);
  if (header.empty()) {
    const std::vector<std::string> names = names_of_comment(head, layout.separator, count);
    if (!names.empty()) layout.names = names;
  }
  fill_names(layout.names);
  if (!options.decimal.empty())
    layout.decimal = decimal_of_option(options.decimal);
  else if (layout.separator != ',' && has_decimal_comma(rows))
    layout.decimal = ',';
  if (layout.separator == ',' && layout.decimal == ',')
    layout.notes.push_back("decimal comma in a table separated by commas: numbers need quotes");
  if (head.latin1 && options.encoding == "utf-8")
    throw DataError(fmt::format("{}: found names that are no UTF-8, expected \"encoding\": \"latin-1\"",
                                shown_path(file)));
  if (head.latin1 && options.encoding.empty()) layout.notes.push_back("names are no UTF-8: read as Latin-1");
  const std::vector<bool> numeric = numeric_columns(rows, count);
  TableSource source;
  for (std::size_t c = 0; c < count; ++c) {
    const std::vector<std::string> values = sample_of(rows, c);
    source.fields.push_back({{layout.names[c], values.empty() || numeric[c] ? "number" : "text",
                              rows.empty() || c >= rows[0].size() ? "" : rows[0][c]},
                             {c},
                             {}});
  }
  layout.sources = {source};
  find_time(layout, rows);
  return layout;
}

}  // namespace odobench
