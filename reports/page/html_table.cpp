#include "reports/page/html_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "reports/page/html_text.hpp"
#include "reports/render/cell_text.hpp"
#include "reports/render/text_width.hpp"

namespace odobench {
namespace {

// Rows; a table with more scrolls inside the page.
constexpr std::size_t kLongTable = 40;
// Characters; a longer text is not squeezed into a narrow column.
constexpr int kLongText = 48;

struct ColumnLayout {
  int tail = 0;  // characters after the number that every row keeps free, so that numbers stand under numbers
  bool number = false;
  bool starts_group = false;
};

std::vector<ColumnLayout> lay_out(const Table& table) {
  std::vector<ColumnLayout> layout(table.columns.size());
  for (std::size_t c = 0; c < layout.size(); ++c) {
    const std::string& group = table.columns[c].group;
    layout[c].starts_group = c > 0 && !group.empty() && group != table.columns[c - 1].group;
    if (c > 0 && group.empty() && !table.columns[c - 1].group.empty()) layout[c].starts_group = true;
    layout[c].number = table.columns[c].align == Align::Right;
    for (const auto& row : table.rows) {
      layout[c].number |= row[c].value.has_value();
      if (row[c].value || row[c].empty())
        layout[c].tail = std::max(layout[c].tail, display_width(cell_text(row[c]).tail));
    }
  }
  return layout;
}

std::string column_class(const ColumnLayout& column) {
  if (column.number) return column.starts_group ? " class=\"n g\"" : " class=\"n\"";
  return column.starts_group ? " class=\"g\"" : "";
}

std::string header(const Table& table, const std::vector<ColumnLayout>& layout) {
  std::string out = "<thead><tr>";
  for (std::size_t c = 0; c < layout.size(); ++c) {
    const Column& column = table.columns[c];
    out += fmt::format("<th scope=\"col\" data-id=\"{}\"{}>{}", html_escape(column.id),
                       column_class(layout[c]), html_symbol(column.name));
    if (!column.unit.empty())
      out += fmt::format(" <span class=\"unit\">[{}]</span>", html_escape(column.unit));
    out += "</th>";
  }
  return out + "</tr></thead>\n";
}

// Numbers of people have a minus sign, not a hyphen; exponents keep theirs.
std::string typeset(const std::string& number) {
  return number.starts_with('-') ? "\u2212" + number.substr(1) : number;
}

// The number or text, then bracket and mark in a field of the column's width.
std::string cell_content(const Cell& cell, const ColumnLayout& column) {
  const CellText text = cell_text(cell);
  std::string out = html_escape(cell.value ? typeset(text.head) : text.head);
  if (cell.empty()) out = "<span class=\"none\">" + out + "</span>";
  if (column.tail == 0 || !column.number || (!cell.value && !cell.empty()))
    return text.tail.empty() ? out : out + " " + html_escape(text.tail);
  out += fmt::format("<span class=\"tail\" style=\"min-width:{}ch\">", column.tail);
  if (!text.tail.empty()) out += " ";
  if (cell.difference) {
    const std::size_t end = text.tail.find(')') + 1;  // of "(-0.012345)"
    out +=
        fmt::format("<span class=\"change\">({}</span>", html_escape(typeset(text.tail.substr(1, end - 1))));
    out += html_escape(text.tail.substr(end));
  } else {
    out += html_escape(text.tail);
  }
  return out + "</span>";
}

std::string body_cell(const Cell& cell, const ColumnLayout& column, bool first) {
  std::string attributes = first ? " scope=\"row\"" : "";
  attributes += column_class(column);
  if (cell.value) attributes += fmt::format(" data-value=\"{}\"", exact_text(*cell.value));
  if (cell.difference) attributes += fmt::format(" data-difference=\"{}\"", exact_text(*cell.difference));
  const char* tag = first ? "th" : "td";
  std::string content = cell_content(cell, column);
  if (cell.best) content = "<b class=\"best\" title=\"best of the column\">" + content + "</b>";
  if (!cell.value && display_width(cell.text) > kLongText)
    content = "<div class=\"text\">" + content + "</div>";
  return fmt::format("<{}{}>{}</{}>", tag, attributes, content, tag);
}

std::string column_groups(const std::vector<ColumnLayout>& layout) {
  std::string out;
  for (std::size_t c = 0; c < layout.size();) {
    std::size_t end = c + 1;
    while (end < layout.size() && !layout[end].starts_group && c > 0) ++end;
    out += fmt::format("<colgroup span=\"{}\"></colgroup>", end - c);
    c = end;
  }
  return out + "\n";
}

std::string notes(const Table& table) {
  if (table.notes.empty()) return "";
  std::string out = "<ul class=\"notes\">";
  for (const std::string& note : table.notes) out += "<li>" + html_escape(note) + "</li>";
  return out + "</ul>\n";
}

}  // namespace

std::string render_html_table(const Table& unmarked, const std::string& anchor, int number) {
  Table table = unmarked;
  mark_best(table);
  if (const std::string note = worse_note(table); !note.empty())
    table.notes.insert(table.notes.begin(), note);
  for (std::size_t r = 0; r < table.rows.size(); ++r)
    if (table.rows[r].size() != table.columns.size())
      throw std::invalid_argument(fmt::format("table '{}', row {}: {} cells, expected {}", table.id, r + 1,
                                              table.rows[r].size(), table.columns.size()));
  const std::vector<ColumnLayout> layout = lay_out(table);
  const std::string id = html_escape(anchor);
  std::string out = fmt::format("<div class=\"table\" id=\"{}\">\n", id);
  out += fmt::format(
      "<div class=\"scroll{}\" tabindex=\"0\" role=\"region\" aria-labelledby=\"{}-title\"><table "
      "data-table=\"{}\">\n",
      table.rows.size() > kLongTable ? " long" : "", id, html_escape(table.id));
  out += fmt::format(
      "<caption><span id=\"{}-title\"><span class=\"number\">Table {}.</span> {}</span></caption>\n", id,
      number, html_escape(table.title));
  out += column_groups(layout) + header(table, layout) + "<tbody>\n";
  for (const auto& row : table.rows) {
    out += "<tr>";
    for (std::size_t c = 0; c < row.size(); ++c) out += body_cell(row[c], layout[c], c == 0);
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n" + notes(table) + "</div>\n";
}

}  // namespace odobench
