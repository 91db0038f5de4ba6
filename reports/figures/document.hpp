// A report as data: sections of text, tables and figures. Pages and files are renderings of it.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <variant>
#include <vector>

#include "reports/render/table.hpp"

namespace odobench {

// A chart as a Vega-Lite 6 specification that names no colours and no fonts: page and print have their own.
//
// Its data are {"name": NAME, "format": {"type": "csv", "parse": {..}}}, NAME one of Document::datasets;
// standalone() puts the text in its place. Widths of views are for print (single view: kFigureWidth); a page
// replaces them by what there is. What a reader may choose is a top-level parameter {"name", "value"} that
// the specification filters by, offered as
//   "usermeta": {"odobench": {"columns": views side by side (default 1),
//                             "aspect": "equal" to keep width : height (default: the height stays),
//                             "controls": [{"param": "method", "label": "Method",
//                                           "options": [{"value": "lm", "label": "lm"}, ..]}]}}
struct Figure {
  std::string id;  // stable, of letters, digits, '_', '-' and '.': "path.line_x"; also the name of its file
  std::string title;    // one line
  std::string caption;  // one or two sentences: what is shown and in which units
  nlohmann::json spec;
};

inline constexpr int kFigureWidth = 640;  // px, of a single view

struct Paragraph {
  std::string text;
};

using Block = std::variant<Paragraph, Table, Figure>;

struct Section {
  std::string id;     // of an anchor: "summary"
  std::string title;  // "Summary"
  std::string lead;   // one sentence below the title, may be ""
  std::vector<Block> blocks;
};

struct Document {
  std::string title;
  std::string subtitle;  // what was run, on what, when
  std::vector<Section> sections;
  std::map<std::string, std::string> datasets;  // name -> CSV with a header line, shared by figures
};

// The figures in order of appearance.
std::vector<const Figure*> figures(const Document& document);

// The specification with the text of its data sets inline: what any Vega-Lite renderer can draw. Throws
// std::invalid_argument naming figure and data set when the document lacks one.
nlohmann::json standalone(const Figure& figure, const std::map<std::string, std::string>& datasets);

// One self-contained HTML page, see reports/page/html_page.cpp. Without `charts` (which a binary without the
// chart library, see reports/page/web_assets.hpp, cannot draw) it keeps the tables, and one line says what is
// missing and why.
std::string render_html(const Document& document);
std::string render_html(const Document& document, bool charts);

}  // namespace odobench
