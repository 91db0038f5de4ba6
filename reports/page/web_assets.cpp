#include "reports/page/web_assets.hpp"

#include <stdexcept>
#include <string>

// The assembler puts each file between two symbols of this object file.
#define ODOBENCH_EMBED(symbol, path)                                                            \
  asm(".pushsection .rodata\n"                                                                  \
      ".global " #symbol "_begin\n.global " #symbol "_end\n" #symbol "_begin:\n.incbin \"" path \
      "\"\n" #symbol "_end:\n.byte 0\n.popsection\n");                                          \
  extern "C" const char symbol##_begin[];                                                       \
  extern "C" const char symbol##_end[]

ODOBENCH_EMBED(odobench_page_css, ODOBENCH_WEB "page.css");
ODOBENCH_EMBED(odobench_theme_js, ODOBENCH_WEB "theme.js");
ODOBENCH_EMBED(odobench_charts_js, ODOBENCH_WEB "charts.js");
ODOBENCH_EMBED(odobench_page_js, ODOBENCH_WEB "page.js");
ODOBENCH_EMBED(odobench_render_svg_js, ODOBENCH_WEB "render_svg.js");
ODOBENCH_EMBED(odobench_vega_js, ODOBENCH_CHART_FOLDER "vega.min.js");
ODOBENCH_EMBED(odobench_vega_lite_js, ODOBENCH_CHART_FOLDER "vega-lite.min.js");
ODOBENCH_EMBED(odobench_missing, ODOBENCH_CHART_FOLDER "missing.txt");
ODOBENCH_EMBED(odobench_licences, ODOBENCH_CHART_FOLDER "licences.txt");

namespace odobench {
namespace {

std::string_view between(const char* begin, const char* end) {
  return {begin, static_cast<std::size_t>(end - begin)};
}

}  // namespace

std::string_view web_file(std::string_view name) {
  if (name == "page.css") return between(odobench_page_css_begin, odobench_page_css_end);
  if (name == "theme.js") return between(odobench_theme_js_begin, odobench_theme_js_end);
  if (name == "charts.js") return between(odobench_charts_js_begin, odobench_charts_js_end);
  if (name == "page.js") return between(odobench_page_js_begin, odobench_page_js_end);
  if (name == "render_svg.js") return between(odobench_render_svg_js_begin, odobench_render_svg_js_end);
  throw std::invalid_argument("no file '" + std::string(name) + "' is embedded");
}

WebFile chart_library(int index) {
  if (index == 0) return {"vega.min.js", between(odobench_vega_js_begin, odobench_vega_js_end)};
  if (index == 1)
    return {"vega-lite.min.js", between(odobench_vega_lite_js_begin, odobench_vega_lite_js_end)};
  throw std::invalid_argument("the chart library has " + std::to_string(kChartLibraryFiles) + " files");
}

bool has_chart_library() {
  return !chart_library(0).text.empty() && !chart_library(1).text.empty();
}

std::string_view why_no_charts() {
  return between(odobench_missing_begin, odobench_missing_end);
}

std::string_view chart_licences() {
  return between(odobench_licences_begin, odobench_licences_end);
}

}  // namespace odobench
