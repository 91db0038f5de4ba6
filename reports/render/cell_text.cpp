#include "reports/render/cell_text.hpp"

#include <fmt/format.h>

#include <cmath>

namespace odobench {

std::string number_text(double value, Notation notation, int precision, bool plus) {
  if (std::isnan(value)) return "nan";
  const bool fixed = notation == Notation::Fixed && std::abs(value) < 1e15;
  const int digits = notation == Notation::Fixed && !fixed ? 6 : precision;
  const std::string text =
      fixed ? fmt::format("{:.{}f}", value, digits) : fmt::format("{:.{}g}", value, digits);
  const bool zero = std::isfinite(value) && text.find_first_of("123456789") == std::string::npos;
  if (zero && text[0] == '-') return text.substr(1);
  return plus && !zero && text[0] != '-' ? fmt::format("+{}", text) : text;
}

CellText cell_text(const Cell& cell) {
  if (cell.empty()) return {"–", ""};
  if (!cell.value) return {cell.text, cell.mark};
  CellText text{number_text(*cell.value, cell.notation, cell.precision), ""};
  if (cell.difference)
    text.tail = fmt::format("({})", number_text(*cell.difference, cell.notation, cell.precision, true));
  for (const std::string& mark : {cell.mark, std::string(cell.worse ? "!" : "")})
    if (!mark.empty()) text.tail += (text.tail.empty() ? "" : " ") + mark;
  return text;
}

std::string whole_text(const CellText& text) {
  return text.tail.empty() ? text.head : text.head + " " + text.tail;
}

std::string heading(const Column& column) {
  return column.unit.empty() ? column.name : column.name + " [" + column.unit + "]";
}

}  // namespace odobench
