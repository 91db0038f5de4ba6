// Cells as people read them; shared by the renderers.
#pragma once

#include <string>

#include "reports/render/table.hpp"

namespace odobench {

// Never "-0.000": what rounds to zero has no sign. `plus` writes the sign of positive numbers too. Fixed
// notation falls back to 6 significant digits from 1e15 on. "inf", "-inf", "nan" for what is not finite.
std::string number_text(double value, Notation notation, int precision, bool plus = false);

// The number or text, and what follows it: "(-0.012345)", "U" or "(-0.012345) U"; "!" at the end of what is
// worse than nominal. A cell without content
// is an en dash.
struct CellText {
  std::string head, tail;
};
CellText cell_text(const Cell& cell);

// "head tail"
std::string whole_text(const CellText& text);

// "e_x,max [m]"
std::string heading(const Column& column);

}  // namespace odobench
