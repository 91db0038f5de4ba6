// A table as HTML.
#pragma once

#include <string>

#include "reports/render/table.hpp"

namespace odobench {

// <div class="table" id=ANCHOR> with a <table> that scrolls sideways in it and the notes below. Every cell
// with a number has it in data-value, and its difference in data-difference, with all digits (exact_text).
// Throws std::invalid_argument naming table and row when a row has another number of cells than there are
// columns.
std::string render_html_table(const Table& table, const std::string& anchor, int number);

}  // namespace odobench
