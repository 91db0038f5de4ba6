// Text and data inside an HTML page, so that nothing of them can be read as markup.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace odobench {

// &, <, >, " and ' as entities: for text and for attributes in double quotes.
std::string html_escape(std::string_view text);

// "e_x,max" with its index as such: <i>e</i><sub>x,max</sub>; a name that is not one letter with an index is
// escaped only.
std::string html_symbol(std::string_view name);

// JSON for a <script> element: no '<' in it, hence no end tag and no comment. What is not UTF-8 is replaced.
std::string html_json(const nlohmann::json& json);

// A program for a <script> element; end tags and comments in its strings are written with a backslash.
std::string html_script(std::string_view program);

// A finite number with as many digits as it takes to read it back, else "nan", "inf" or "-inf".
std::string exact_text(double value);

}  // namespace odobench
