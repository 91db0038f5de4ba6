// One number of a text in whatever way tables write it.
#pragma once

#include <optional>
#include <string_view>

namespace odobench {

// "1.5", "+1e-3", with `point` ',' "1,5" and also "7": the whole text as a double, by std::from_chars.
// Nothing where it is no number, is longer than 64 characters, or `point` is not the mark that it uses; nan
// and inf are numbers here.
std::optional<double> decimal_number(std::string_view text, char point);

}  // namespace odobench
