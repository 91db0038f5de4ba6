// UTF-8 text on a terminal: how many cells it takes, and breaking it into lines.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace odobench {

// Terminal cells: 1 per code point, 0 for combining marks, 2 for East Asian wide characters and pictographs.
// A byte that is not valid UTF-8 counts 1.
int display_width(std::string_view text);

// Lines of at most `width` cells (width >= 2), broken at spaces, else after a comma, else anywhere between
// code points. Line breaks of the text are kept. Always at least one line, without spaces at its ends.
std::vector<std::string> wrap_text(std::string_view text, int width);

std::string pad_left(const std::string& text, int width);
std::string pad_right(const std::string& text, int width);

}  // namespace odobench
