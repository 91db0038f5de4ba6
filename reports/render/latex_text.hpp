// Text, units and labels as LaTeX wants them.
#pragma once

#include <string>
#include <string_view>

namespace odobench {

// Everything with a meaning in LaTeX escaped, Greek letters and signs that the tables use as mathematics.
// Other letters beyond ASCII stay as they are: pdflatex knows the Latin ones, lualatex what its font has.
std::string latex_text(std::string_view text);

// The same, and a line may break behind '/', ',', '_', '|' and ':', which paths and lists of values have
// instead of blanks.
std::string breakable_latex(const std::string& text);

// \unit{\milli\metre} of siunitx for the units of the tables; what is not known is written as it is.
std::string latex_unit(const std::string& unit);

// Of \label and \ref: no character that is special there.
std::string latex_label(const std::string& id);

}  // namespace odobench
