// What an HTML report and the SVG files consist of besides data: files of reports/web/, and the chart library
// (Vega and Vega-Lite, minified) that the build fetches with npm; the repository holds none of its code.
#pragma once

#include <string_view>

namespace odobench {

struct WebFile {
  std::string_view name;  // "page.css"
  std::string_view text;
};

// Our own: page.css, theme.js, charts.js, page.js, render_svg.js. Throws std::invalid_argument for another
// name.
std::string_view web_file(std::string_view name);

// The chart library in the order in which its files have to be run; `text` is empty when it was built
// without.
inline constexpr int kChartLibraryFiles = 2;
WebFile chart_library(int index);  // vega.min.js, vega-lite.min.js
bool has_chart_library();
// Why it was built without: "npm was not installed when it was configured"; "" when it has the library.
std::string_view why_no_charts();

// The licences of the chart library and of what is inside it; "" when built without.
std::string_view chart_licences();

}  // namespace odobench
