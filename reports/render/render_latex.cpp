// LaTeX: one table environment per table, of booktabs rules and siunitx columns.
//
// A table that is wider than a page is cut between groups into blocks below each other, as on a terminal; one
// that is longer goes on in further environments. What still is too wide (a single column of long numbers) is
// shrunk.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "reports/render/cell_text.hpp"
#include "reports/render/latex_text.hpp"
#include "reports/render/table.hpp"
#include "reports/render/text_width.hpp"

namespace odobench {
namespace {

// In digits of the type in use; a line of the article class holds 345 pt.
constexpr double kSmallLine = 68, kFootnoteLine = 80;
constexpr double kGap = 1.8;             // between columns, tabcolsep of 4 pt on both sides
constexpr int kWidestText = 26;          // text columns are wrapped beyond it
constexpr int kNarrowHeading = 12;       // headings are wrapped down to this
constexpr std::size_t kMostLines = 46;   // of a page, over all blocks, without notes
constexpr std::size_t kHeaderLines = 4;  // rules, names and units of a block

// Digits of a number before and after the point and of its exponent, with their signs.
struct NumberShape {
  bool minus = false, exponent = false, exponent_minus = false;
  int whole = 1, decimals = 0, exponent_digits = 0;

  void add(const std::string& text) {
    const auto e = text.find('e');
    const std::string mantissa = text.substr(0, e);
    const auto point = mantissa.find('.');
    minus = minus || mantissa[0] == '-';
    const auto digits = [](const std::string& part) {
      return static_cast<int>(
          std::count_if(part.begin(), part.end(), [](char c) { return c >= '0' && c <= '9'; }));
    };
    whole = std::max(whole, digits(mantissa.substr(0, point)));
    if (point != std::string::npos) decimals = std::max(decimals, digits(mantissa.substr(point)));
    if (e == std::string::npos) return;
    const int power = std::stoi(text.substr(e + 1));
    exponent = true;
    exponent_minus = exponent_minus || power < 0;
    exponent_digits = std::max(exponent_digits, digits(std::to_string(power)));
  }
  std::string format() const {
    std::string text = fmt::format("{}{}", minus ? "-" : "", whole);
    if (decimals > 0) text += fmt::format(".{}", decimals);
    if (exponent) text += fmt::format("e{}{}", exponent_minus ? "-" : "", exponent_digits);
    return text;
  }
  double width() const {
    const double mantissa = whole + (decimals > 0 ? decimals + 0.5 : 0) + (minus ? 1.5 : 0);
    return mantissa + (exponent ? 3.5 + 0.7 * (exponent_digits + (exponent_minus ? 1 : 0)) : 0);
  }
};

bool is_number(const Cell& cell) {
  return cell.value && std::isfinite(*cell.value);
}

std::string shown_number(const Cell& cell) {
  return number_text(*cell.value, cell.notation, cell.precision);
}

std::string difference_text(const Cell& cell) {
  return fmt::format("({})", number_text(*cell.difference, cell.notation, cell.precision, true));
}

// One column of the table: up to three of the tabular.
struct LatexColumn {
  std::size_t column = 0;
  bool numbers = false, differences = false, marks = false;
  NumberShape shape;
  double content = 0;  // width of the cells, in digits
  double width = 0;    // with the heading
  bool wraps = false;
  double natural = 0;                // width of a text column that wraps, if it did not
  std::vector<std::string> heading;  // lines
  std::size_t parts() const { return 1u + (differences ? 1 : 0) + (marks ? 1 : 0); }
};

LatexColumn lay_out(const Table& table, std::size_t c) {
  const Column& column = table.columns[c];
  LatexColumn out;
  out.column = c;
  int text = 0, difference = 0, mark = 0;
  for (const auto& row : table.rows) {
    const Cell& cell = row[c];
    if (is_number(cell)) {
      out.numbers = true;
      out.shape.add(shown_number(cell));
    } else {
      text = std::max(text, display_width(cell_text(cell).head));
    }
    if (cell.difference) difference = std::max(difference, display_width(difference_text(cell)));
    mark = std::max(mark, display_width(cell.mark));
  }
  out.differences = difference > 0;
  out.marks = mark > 0;
  out.wraps = !out.numbers && text > kWidestText;
  out.natural = text;
  out.content =
      std::max<double>(out.numbers ? out.shape.width() : 0, std::min(text, out.numbers ? text : kWidestText));
  out.content += (difference > 0 ? difference + 0.7 : 0) + (mark > 0 ? mark + 0.7 : 0);
  const int heading = std::max(kNarrowHeading, static_cast<int>(out.content));
  out.heading =
      column.latex.empty() ? wrap_text(column.name, heading) : std::vector<std::string>{column.latex};
  double widest = column.latex.empty() ? 0 : 6;
  if (column.latex.empty())
    for (const std::string& line : out.heading) widest = std::max<double>(widest, display_width(line));
  if (!column.unit.empty()) widest = std::max<double>(widest, display_width(column.unit) + 2);
  out.width = std::max(out.content, widest);
  return out;
}

using LatexBlock = std::vector<LatexColumn>;

double total_width(const LatexBlock& block) {
  double width = 0;
  for (const LatexColumn& c : block) width += c.width + kGap;
  return width;
}

// As on the console: whole groups while they fit, each block beginning with the first column.
std::vector<LatexBlock> split(const Table& table) {
  const LatexColumn key = lay_out(table, 0);
  std::vector<LatexBlock> blocks{{key}};
  for (std::size_t at = 1; at < table.columns.size();) {
    std::size_t end = at + 1;
    while (end < table.columns.size() && !table.columns[at].group.empty() &&
           table.columns[end].group == table.columns[at].group)
      ++end;
    LatexBlock group, extended = blocks.back();
    for (; at < end; ++at) group.push_back(lay_out(table, at));
    extended.insert(extended.end(), group.begin(), group.end());
    if (total_width(extended) <= kFootnoteLine) {
      blocks.back() = std::move(extended);
      continue;
    }
    if (blocks.back().size() > 1) blocks.push_back({key});
    for (const LatexColumn& column : group) {
      if (blocks.back().size() > 1 && total_width(blocks.back()) + column.width + kGap > kFootnoteLine)
        blocks.push_back({key});
      blocks.back().push_back(column);
    }
  }
  return blocks;
}

// What a block leaves of the line goes to its wrapped columns, the narrowest first.
void widen(LatexBlock& block, double line) {
  for (double rest = line - total_width(block); rest >= 1; rest -= 1) {
    LatexColumn* narrowest = nullptr;
    for (LatexColumn& c : block)
      if (c.wraps && c.width < c.natural && (narrowest == nullptr || c.width < narrowest->width))
        narrowest = &c;
    if (narrowest == nullptr) return;
    narrowest->width += 1;
  }
}

std::string column_specification(const LatexColumn& c, const Column& column) {
  std::string out;
  if (c.numbers)
    out = fmt::format("S[table-format={}]", c.shape.format());
  else if (c.wraps)
    out = fmt::format(">{{\\raggedright\\arraybackslash}}p{{{:.1f}em}}", 0.5 * c.width);
  else
    out = column.align == Align::Right ? "r" : "l";
  if (c.differences) out += "@{\\,}r";
  if (c.marks) out += "@{\\,}l";
  return out;
}

std::string heading_text(const LatexColumn& c, const Column& column) {
  if (!column.latex.empty()) return column.latex;
  if (c.heading.size() == 1) return latex_text(c.heading[0]);
  std::string lines;
  for (const std::string& line : c.heading) lines += (lines.empty() ? "" : " \\\\ {}") + latex_text(line);
  return fmt::format("\\begin{{tabular}}[b]{{@{{}}{}@{{}}}}{}\\end{{tabular}}", c.numbers ? 'c' : 'l', lines);
}

// A cell of a heading over all parts of the column. Braces keep siunitx from reading it as a number.
std::string over_parts(const LatexColumn& c, const std::string& text) {
  if (c.parts() > 1) return fmt::format("\\multicolumn{{{}}}{{c}}{{{}}}", c.parts(), text);
  return c.numbers ? "{" + text + "}" : text;
}

// The name of a group is shown unless its columns say it themselves: a1, a2 of a.
std::string group_heading(const Table& table, const LatexBlock& block, std::size_t begin, std::size_t end) {
  const std::string& group = table.columns[block[begin].column].group;
  if (group.empty() || end - begin < 2) return "";
  bool all_say_so = true, one_is_it = false;
  for (std::size_t k = begin; k < end; ++k) {
    const std::string& name = table.columns[block[k].column].name;
    all_say_so &= name.rfind(group, 0) == 0;
    one_is_it |= name == group;
  }
  if (all_say_so || one_is_it) return "";
  if (group == "x" || group == "y") return "$" + group + "$";
  if (group == "theta") return "$\\theta$";
  std::string name = group;
  std::replace(name.begin(), name.end(), '_', ' ');
  return latex_text(name);
}

std::string group_row(const Table& table, const LatexBlock& block) {
  std::string names, rules;
  std::size_t first = 1;  // part that the group begins with, counted from 1
  for (std::size_t begin = 0; begin < block.size();) {
    std::size_t end = begin + 1, parts = block[begin].parts();
    const std::string& group = table.columns[block[begin].column].group;
    while (end < block.size() && !group.empty() && table.columns[block[end].column].group == group)
      parts += block[end++].parts();
    const std::string name = group_heading(table, block, begin, end);
    if (begin > 0) names += " & ";
    names += fmt::format("\\multicolumn{{{}}}{{c}}{{{}}}", parts, name);
    if (!name.empty()) rules += fmt::format("\\cmidrule(lr){{{}-{}}}", first, first + parts - 1);
    first += parts;
    begin = end;
  }
  return rules.empty() ? "" : names + " \\\\\n" + rules + "\n";
}

std::string header(const Table& table, const LatexBlock& block) {
  std::string names, units;
  bool any_unit = false;
  for (std::size_t k = 0; k < block.size(); ++k) {
    const Column& column = table.columns[block[k].column];
    const std::string gap = k == 0 ? "" : " & ";
    names += gap + over_parts(block[k], heading_text(block[k], column));
    units += gap + (column.unit.empty() ? over_parts(block[k], "")
                                        : over_parts(block[k], "[" + latex_unit(column.unit) + "]"));
    any_unit |= !column.unit.empty();
  }
  return group_row(table, block) + names + " \\\\\n" + (any_unit ? units + " \\\\\n" : "");
}

std::string cell_latex(const LatexColumn& c, const Cell& cell, bool first) {
  const std::string bold = cell.best ? "\\bfseries " : "";
  std::string out;
  if (is_number(cell)) {
    std::string number = shown_number(cell);
    if (const auto e = number.find('e'); e != std::string::npos)
      number = fmt::format("{}e{}", number.substr(0, e), std::stoi(number.substr(e + 1)));
    out = bold + number;
  } else {
    const std::string head = cell_text(cell).head;
    const std::string text = head == "inf"    ? "$\\infty$"
                             : head == "-inf" ? "$-\\infty$"
                             : c.wraps        ? breakable_latex(head)
                                              : latex_text(head);
    out = c.numbers ? "{" + text + "}" : bold + text;
    // A bracket at the start of a row would be taken for the argument of the "\\" before it.
    if (first && !text.empty() && text[0] == '[') out = "{}" + out;
  }
  if (c.differences) out += cell.difference ? fmt::format(" & ${}$", difference_text(cell)) : " &";
  if (c.marks) out += cell.mark.empty() ? " &" : " & " + latex_text(cell.mark);
  return out;
}

std::string block_latex(const Table& table, const LatexBlock& block, std::size_t begin, std::size_t end) {
  std::string columns;
  for (const LatexColumn& c : block) columns += column_specification(c, table.columns[c.column]);
  // Shrinks only what is wider than the line.
  std::string out =
      "\\resizebox{\\ifdim\\width>\\linewidth\\linewidth\\else\\width\\fi}{!}{%\n\\begin{tabular}{" +
      columns + "}\n\\toprule\n" + header(table, block) + "\\midrule\n";
  for (std::size_t row = begin; row < end; ++row) {
    for (std::size_t k = 0; k < block.size(); ++k)
      out += (k == 0 ? "" : " & ") + cell_latex(block[k], table.rows[row][block[k].column], k == 0);
    out += " \\\\\n";
  }
  return out + "\\bottomrule\n\\end{tabular}}\n";
}

std::string notes_latex(const Table& table) {
  if (table.notes.empty()) return "";
  std::string out = "\\par\\smallskip\n\\begin{minipage}{\\linewidth}\\footnotesize\\raggedright\n";
  for (const std::string& note : table.notes) out += latex_text(note) + "\\par\n";
  return out + "\\end{minipage}\n";
}

// Lines that a row takes in all blocks.
std::size_t height(const Table& table, const std::vector<LatexBlock>& blocks, std::size_t row) {
  std::size_t sum = 0;
  for (const LatexBlock& block : blocks) {
    std::size_t lines = 1;
    for (const LatexColumn& c : block)
      if (c.wraps)
        lines = std::max(lines, static_cast<std::size_t>(
                                    std::ceil(display_width(table.rows[row][c.column].text) / c.width)));
    sum += lines;
  }
  return sum;
}

std::string table_latex(const Table& table) {
  std::vector<LatexBlock> blocks = split(table);
  const bool small = std::all_of(blocks.begin(), blocks.end(),
                                 [](const LatexBlock& block) { return total_width(block) <= kSmallLine; });
  for (LatexBlock& block : blocks) widen(block, small ? kSmallLine : kFootnoteLine);
  std::string out;
  std::size_t begin = 0;
  do {
    std::size_t end = begin, lines = blocks.size() * kHeaderLines;
    while (end < table.rows.size() && (end == begin || lines + height(table, blocks, end) <= kMostLines))
      lines += height(table, blocks, end++);
    // LaTeX gives up with some fifty floats that wait for their page.
    out += begin == 0 ? "" : "\\clearpage\n";
    out += "\\begin{table}[htbp]\n\\centering\n";
    out += fmt::format("\\caption{}{{{}{}}}\n", begin == 0 ? "" : "[]", latex_text(table.title),
                       begin == 0 ? "" : ", continued");
    if (begin == 0) out += fmt::format("\\label{{tab:{}}}\n", latex_label(table.id));
    out += "\\par\\smallskip\n";
    out += fmt::format("{}\\setlength{{\\tabcolsep}}{{4pt}}\n", small ? "\\small" : "\\footnotesize");
    out += "\\sisetup{mode=text, reset-text-series=false, group-digits=none, table-align-exponent=false}\n";
    for (std::size_t b = 0; b < blocks.size(); ++b)
      out += (b == 0 ? "" : "\\par\\medskip\n") + block_latex(table, blocks[b], begin, end);
    if (end == table.rows.size()) out += notes_latex(table);
    out += "\\end{table}\n";
    begin = end;
  } while (begin < table.rows.size());
  return out;
}

}  // namespace

std::string render_latex(const std::vector<Table>& tables) {
  if (tables.empty()) return "";
  std::string out =
      "% \\usepackage[T1]{fontenc}\n% \\usepackage{array, booktabs, graphicx}\n% \\usepackage{siunitx}  % "
      "version 3\n";
  for (std::size_t k = 0; k < tables.size(); ++k) {
    if (k > 0) out += '\n';
    out += table_latex(tables[k]);
  }
  return out;
}

}  // namespace odobench
