#include "reports/render/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>

#include "base/text.hpp"
#include "reports/render/cell_text.hpp"

namespace odobench {
namespace {

struct FormatName {
  Format format;
  const char* name;
  const char* extension;
};
constexpr std::array<FormatName, 5> kFormats{{{Format::Console, "console", "txt"},
                                              {Format::Markdown, "md", "md"},
                                              {Format::Csv, "csv", "csv"},
                                              {Format::Json, "json", "json"},
                                              {Format::Latex, "latex", "tex"}}};

const FormatName& entry(Format format) {
  for (const FormatName& known : kFormats)
    if (known.format == format) return known;
  throw std::invalid_argument("not a table format");
}

void check(const Table& table) {
  if (table.columns.empty()) throw std::invalid_argument(fmt::format("table '{}': no columns", table.id));
  std::set<std::string> ids;
  for (const Column& column : table.columns)
    if (!ids.insert(column.id).second)
      throw std::invalid_argument(
          fmt::format("table '{}': two columns with the id '{}'", table.id, column.id));
  for (std::size_t i = 0; i < table.rows.size(); ++i)
    if (table.rows[i].size() != table.columns.size())
      throw std::invalid_argument(fmt::format("table '{}': row {} has {} cells, expected {}", table.id, i + 1,
                                              table.rows[i].size(), table.columns.size()));
}

double rounding_of(const Cell& cell) {
  return kRepeats * std::abs(*cell.value);
}
double noise_of(const Cell& cell) {
  return std::max(cell.noise.value_or(0.0), rounding_of(cell));
}

// The number of the reference row, where there is exactly one and it is finite.
std::optional<double> reference_of(const Table& table, std::size_t column) {
  if (table.references.size() != 1) return std::nullopt;
  const std::optional<double>& value = table.rows[table.references.front()][column].value;
  return value && std::isfinite(*value) ? value : std::nullopt;
}

void mark_column(Table& table, std::size_t column) {
  const double sign = table.columns[column].better == Better::Higher ? -1 : 1;
  const std::optional<double> reference = reference_of(table, column);
  std::vector<Cell*> competing;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const auto& none = table.references;
    Cell& cell = table.rows[i][column];
    if (!cell.value || std::find(none.begin(), none.end(), i) != none.end()) continue;
    // An unknown noise is one of the method; that this result is worse is a fact.
    const double noise = std::isinf(noise_of(cell)) ? rounding_of(cell) : noise_of(cell);
    if (reference) cell.worse = !std::isfinite(*cell.value) || sign * (*cell.value - *reference) > noise;
    if (std::isfinite(*cell.value)) competing.push_back(&cell);
  }
  if (competing.size() < 2) return;
  const Cell* best =
      *std::min_element(competing.begin(), competing.end(),
                        [sign](const Cell* a, const Cell* b) { return sign * *a->value < sign * *b->value; });
  double noise = noise_of(*best);
  for (const Cell* cell : competing)
    if (std::abs(*cell->value - *best->value) <= rounding_of(*best)) noise = std::min(noise, noise_of(*cell));
  if (reference && !(sign * (*reference - *best->value) > noise)) return;
  const std::string shown = cell_text(*best).head;
  const auto ties = [&](const Cell* cell) {
    return std::abs(*cell->value - *best->value) <= noise || cell_text(*cell).head == shown;
  };
  if (std::all_of(competing.begin(), competing.end(), ties)) return;
  for (Cell* cell : competing) cell->best = ties(cell);
}

// For the formats that people read: what is best and what is worse than nominal, explained below the first
// table that needs it.
void mark_for_people(std::vector<Table>& tables, Format format) {
  bool explained = false;
  for (Table& table : tables) {
    mark_best(table);
    const std::string note = worse_note(table);
    if (!note.empty() && !explained) table.notes.insert(table.notes.begin(), note);
    explained = explained || !note.empty();
    if (format != Format::Latex) continue;
    for (auto& row : table.rows)
      for (Cell& cell : row)
        if (cell.worse) cell.mark += "!";
  }
}

// `lines`: line breaks stay, as a quoted field of CSV may have them.
std::string seen_text(const std::string& text, bool lines) {
  std::string out;
  std::size_t begin = 0;
  for (std::size_t at = 0; at <= text.size(); ++at) {
    const bool blank = at < text.size() && (text[at] == '\n' || text[at] == '\r' || text[at] == '\t');
    if (at < text.size() && !blank) continue;
    out += printable(std::string_view(text).substr(begin, at - begin));
    if (blank) out += lines && text[at] == '\n' ? '\n' : ' ';
    begin = at + 1;
  }
  return out;
}

// Names come from files and may hold what a terminal obeys; JSON has escapes of its own.
void make_printable(Table& table, bool lines) {
  table.title = seen_text(table.title, lines);
  for (std::string& note : table.notes) note = seen_text(note, lines);
  for (Column& column : table.columns)
    for (std::string* text : {&column.id, &column.name, &column.unit, &column.group})
      *text = seen_text(*text, lines);
  for (auto& row : table.rows)
    for (Cell& cell : row)
      for (std::string* text : {&cell.text, &cell.mark}) *text = seen_text(*text, lines);
}

}  // namespace

Cell text_cell(std::string text) {
  Cell cell;
  cell.text = std::move(text);
  return cell;
}
Cell fixed_cell(double value, int digits) {
  Cell cell;
  cell.value = value;
  cell.precision = digits;
  return cell;
}
Cell significant_cell(double value, int digits) {
  Cell cell = fixed_cell(value, digits);
  cell.notation = Notation::Significant;
  return cell;
}
Cell count_cell(double value) {
  return fixed_cell(value, 0);
}

Format parse_format(const std::string& name) {
  for (const FormatName& known : kFormats)
    if (name == known.name) return known.format;
  throw std::invalid_argument(
      fmt::format("unknown table format '{}', expected console, md, csv, json or latex", name));
}
std::string to_string(Format format) {
  return entry(format).name;
}
std::string file_extension(Format format) {
  return entry(format).extension;
}

Column text_column(std::string id, std::string name, std::string group) {
  Column column = number_column(std::move(id), std::move(name), "", std::move(group));
  column.align = Align::Left;
  return column;
}

Column number_column(std::string id, std::string name, std::string unit, std::string group,
                     std::string latex) {
  if (name.empty()) {
    name = id;
    std::replace(name.begin(), name.end(), '_', ' ');
  }
  return {std::move(id), std::move(name), std::move(unit), std::move(latex), std::move(group)};
}

Column best_if(Better better, Column column) {
  column.better = better;
  return column;
}

void mark_best(Table& table) {
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    if (table.columns[c].better != Better::None) mark_column(table, c);
}

std::string worse_note(const Table& table) {
  for (const auto& row : table.rows)
    for (const Cell& cell : row)
      if (cell.worse)
        return fmt::format("!: worse than {}.", cell_text(table.rows[table.references.front()].front()).head);
  return "";
}

std::string render(const std::vector<Table>& given, Format format, const RenderOptions& options) {
  for (const Table& table : given) check(table);
  std::vector<Table> tables = given;
  if (format != Format::Json)
    for (Table& table : tables) make_printable(table, format == Format::Csv);
  if (format != Format::Csv && format != Format::Json) mark_for_people(tables, format);
  switch (format) {
    case Format::Console:
      return render_console(tables, options);
    case Format::Markdown:
      return render_markdown(tables);
    case Format::Csv:
      return render_csv(tables);
    case Format::Json:
      return render_json(tables);
    case Format::Latex:
      return render_latex(tables);
  }
  throw std::invalid_argument("not a table format");
}

bool empty_column(const Table& table, std::size_t c) {
  return std::all_of(table.rows.begin(), table.rows.end(),
                     [c](const std::vector<Cell>& row) { return row[c].empty(); });
}

void erase_column(Table& table, std::size_t c) {
  const auto at = static_cast<std::ptrdiff_t>(c);
  table.columns.erase(table.columns.begin() + at);
  for (std::vector<Cell>& row : table.rows) row.erase(row.begin() + at);
}

std::vector<std::string> sentences_of(const Table& table) {
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    if (table.columns[c].id != table.sentences) continue;
    std::vector<std::string> list;
    for (const std::vector<Cell>& row : table.rows) list.push_back(row.at(c).text);
    return list;
  }
  throw std::invalid_argument(fmt::format("table '{}' has no column '{}'", table.id, table.sentences));
}

}  // namespace odobench
