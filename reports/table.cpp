#include "reports/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>

#include "reports/cell_text.hpp"

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

Column best_if(Better better, Column column) {
  column.better = better;
  return column;
}

void mark_best(Table& table) {
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const double sign = table.columns[c].better == Better::Higher ? -1 : 1;
    if (table.columns[c].better == Better::None) continue;
    std::vector<Cell*> competing;
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
      const auto& none = table.references;
      Cell& cell = table.rows[i][c];
      const bool takes_part = cell.value && std::isfinite(*cell.value);
      if (takes_part && std::find(none.begin(), none.end(), i) == none.end()) competing.push_back(&cell);
    }
    if (competing.size() < 2) continue;
    const Cell* best = *std::min_element(
        competing.begin(), competing.end(),
        [sign](const Cell* a, const Cell* b) { return sign * *a->value < sign * *b->value; });
    const std::string shown = cell_text(*best).head;
    const auto reads_the_same = [&](const Cell* cell) { return cell_text(*cell).head == shown; };
    if (std::all_of(competing.begin(), competing.end(), reads_the_same)) continue;
    for (Cell* cell : competing) cell->best = reads_the_same(cell);
  }
}

std::string render(const std::vector<Table>& given, Format format, const RenderOptions& options) {
  for (const Table& table : given) check(table);
  std::vector<Table> tables = given;
  for (Table& table : tables) mark_best(table);
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

}  // namespace odobench
