#include <fmt/format.h>

#include <array>
#include <cctype>
#include <string_view>
#include <utility>

#include "reports/cell_text.hpp"
#include "reports/table.hpp"

namespace odobench {
namespace {

// Order matters only in that no key is a prefix of another.
constexpr std::array<std::pair<std::string_view, std::string_view>, 27> kReplacements{{
    {"\\", "\\textbackslash{}"},
    {"{", "\\{"},
    {"}", "\\}"},
    {"$", "\\$"},
    {"&", "\\&"},
    {"#", "\\#"},
    {"%", "\\%"},
    {"_", "\\_"},
    {"~", "\\textasciitilde{}"},
    {"^", "\\textasciicircum{}"},
    {"<", "\\textless{}"},
    {">", "\\textgreater{}"},
    {"|", "\\textbar{}"},
    {"\"", "\\textquotedbl{}"},
    {"\n", " "},
    {"\r", ""},
    {"–", "--"},
    {"θ", "$\\theta$"},
    {"σ", "$\\sigma$"},
    {"Σ", "$\\Sigma$"},
    {"Δ", "$\\Delta$"},
    {"×", "$\\times$"},
    {"±", "$\\pm$"},
    {"≤", "$\\leq$"},
    {"≥", "$\\geq$"},
    {"µ", "$\\mu$"},
    {"°", "$^\\circ$"},
}};

std::string escaped(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    bool replaced = false;
    for (const auto& [from, to] : kReplacements) {
      if (text.substr(0, from.size()) != from) continue;
      out += to;
      text.remove_prefix(from.size());
      replaced = true;
      break;
    }
    if (replaced) continue;
    out += text.front();
    text.remove_prefix(1);
  }
  return out;
}

// A real minus sign and a power of ten instead of "e-09".
std::string number(const std::string& text) {
  const auto e = text.find('e');
  if (text == "inf") return "$\\infty$";
  if (text == "-inf") return "$-\\infty$";
  if (e != std::string::npos && e + 1 < text.size() && text != "nan")
    return fmt::format("${}\\times10^{{{}}}$", text.substr(0, e), std::stoi(text.substr(e + 1)));
  return text[0] == '-' || text[0] == '+' ? fmt::format("${}$", text) : text;
}

std::string cell_latex(const Cell& cell) {
  if (!cell.value) return escaped(whole_text(cell_text(cell)));
  std::string out = number(number_text(*cell.value, cell.notation, cell.precision));
  if (cell.difference)
    out += fmt::format(" ({})", number(number_text(*cell.difference, cell.notation, cell.precision, true)));
  if (!cell.mark.empty()) out.append(1, ' ').append(escaped(cell.mark));
  return out;
}

std::string heading_latex(const Column& column) {
  const std::string name = column.latex.empty() ? escaped(column.name) : column.latex;
  return column.unit.empty() ? name : name + " [" + escaped(column.unit) + "]";
}

// Labels of \ref: no character that is special there.
std::string label(const std::string& id) {
  std::string out;
  for (char c : id) out += std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == ':' ? c : '-';
  return out;
}

std::string table_latex(const Table& table) {
  std::string out = "\\begin{table}[htbp]\n\\centering\n\\caption{" + escaped(table.title) +
                    "}\n\\label{tab:" + label(table.id) + "}\n";
  // Shrinks only what is wider than the line.
  out += "\\resizebox{\\ifdim\\width>\\linewidth\\linewidth\\else\\width\\fi}{!}{%\n\\begin{tabular}{";
  for (const Column& column : table.columns) out += column.align == Align::Right ? 'r' : 'l';
  out += "}\n\\toprule\n";
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    out += (c == 0 ? "" : " & ") + heading_latex(table.columns[c]);
  out += " \\\\\n\\midrule\n";
  for (const auto& row : table.rows) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      // A bracket at the start of a row would be taken for the argument of the "\\" before it.
      std::string text = cell_latex(row[c]);
      if (c == 0 && !text.empty() && text[0] == '[') text = "{}" + text;
      out += (c == 0 ? "" : " & ") + text;
    }
    out += " \\\\\n";
  }
  out += "\\bottomrule\n\\end{tabular}}\n";
  if (!table.notes.empty()) {
    out += "\\par\\smallskip\n\\begin{minipage}{\\linewidth}\\footnotesize\n";
    for (const std::string& note : table.notes) out += escaped(note) + "\\par\n";
    out += "\\end{minipage}\n";
  }
  return out + "\\end{table}\n";
}

}  // namespace

std::string render_latex(const std::vector<Table>& tables) {
  if (tables.empty()) return "";
  std::string out = "% packages: booktabs, graphicx; \\usepackage[T1]{fontenc} for quotation marks\n";
  for (std::size_t k = 0; k < tables.size(); ++k) {
    if (k > 0) out += '\n';
    out += table_latex(tables[k]);
  }
  return out;
}

}  // namespace odobench
