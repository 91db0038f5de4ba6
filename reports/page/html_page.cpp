// A page without external resources: style, programs, chart library and data are inside, a content security
// policy forbids every request. Tables are complete without JavaScript; charts are drawn by
// reports/web/charts.js when they come into view.
#include <fmt/format.h>

#include <set>
#include <utility>

#include "reports/figures/document.hpp"
#include "reports/page/html_figure.hpp"
#include "reports/page/html_table.hpp"
#include "reports/page/html_text.hpp"
#include "reports/page/web_assets.hpp"

namespace odobench {
namespace {

// What a document's blocks are numbered and anchored by.
struct Numbering {
  int tables = 0, figures = 0;
  std::set<std::string> anchors;

  std::string anchor(const std::string& wanted) {
    std::string name = wanted;
    for (int k = 2; !anchors.insert(name).second; ++k) name = fmt::format("{}-{}", wanted, k);
    return name;
  }
};

std::string policy(bool charts) {
  // Vega compiles its expressions to functions.
  return fmt::format(
      "default-src 'none'; script-src 'unsafe-inline'{}; style-src 'unsafe-inline'; img-src data: blob:; "
      "base-uri 'none'; form-action 'none'",
      charts ? " 'unsafe-eval'" : "");
}

std::string head(const Document& document, bool charts) {
  std::string out = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
  out += fmt::format("<meta http-equiv=\"Content-Security-Policy\" content=\"{}\">\n", policy(charts));
  out += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n";
  out += "<meta name=\"color-scheme\" content=\"light dark\">\n";
  out += fmt::format("<title>{}</title>\n", html_escape(document.title));
  out += fmt::format("<style>\n{}</style>\n", web_file("page.css"));
  out += fmt::format("<script>\n{}</script>\n", html_script(web_file("theme.js")));
  return out + "</head>\n";
}

std::string top(const Document& document) {
  std::string out = "<body>\n<a class=\"skip\" href=\"#content\">Skip to the content</a>\n";
  out += fmt::format("<header class=\"top\"><div><h1>{}</h1>", html_escape(document.title));
  if (!document.subtitle.empty())
    out += fmt::format("<p class=\"subtitle\">{}</p>", html_escape(document.subtitle));
  out += "</div><div id=\"theme\"></div></header>\n<div class=\"columns\">\n";
  out += "<nav class=\"sections\" aria-label=\"Sections\"><ol>\n";
  for (const Section& section : document.sections)
    out +=
        fmt::format("<li><a href=\"#{}\">{}</a></li>\n", html_escape(section.id), html_escape(section.title));
  return out + "</ol></nav>\n";
}

std::string block_html(const Block& block, Numbering& numbering) {
  if (const auto* paragraph = std::get_if<Paragraph>(&block))
    return fmt::format("<p class=\"text\">{}</p>\n", html_escape(paragraph->text));
  if (const auto* table = std::get_if<Table>(&block))
    return render_html_table(*table, numbering.anchor("table-" + table->id), ++numbering.tables);
  return render_html_figure(std::get<Figure>(block), ++numbering.figures);
}

std::string section_html(const Section& section, Numbering& numbering) {
  const std::string id = html_escape(section.id);
  std::string out =
      fmt::format("<section id=\"{}\" aria-labelledby=\"{}-title\">\n<h2 id=\"{}-title\">{}</h2>\n", id, id,
                  id, html_escape(section.title));
  if (!section.lead.empty()) out += fmt::format("<p class=\"lead\">{}</p>\n", html_escape(section.lead));
  for (const Block& block : section.blocks) out += block_html(block, numbering);
  return out + "</section>\n";
}

std::string footer(bool charts) {
  std::string out = "<footer>\n<p>Made by Odobench. This page needs no network: everything is inside.</p>\n";
  if (charts)
    out += fmt::format(
        "<details class=\"licences\"><summary>Licences of the chart "
        "library</summary><pre>{}</pre></details>\n",
        html_escape(chart_licences()));
  return out + "</footer>\n";
}

// Programs that are run when the first chart is drawn, hence not as JavaScript.
std::string library() {
  std::string out;
  for (int k = 0; k < kChartLibraryFiles; ++k)
    out += fmt::format("<script type=\"text/plain\" class=\"chart-library\">{}</script>\n",
                       html_script(chart_library(k).text));
  return out;
}

// What is not there is not announced: no captions, no sections of figures alone.
Document without_figures(Document document) {
  std::vector<Section> kept;
  for (Section& section : document.sections) {
    std::vector<Block> blocks;
    for (Block& block : section.blocks)
      if (!std::holds_alternative<Figure>(block)) blocks.push_back(std::move(block));
    section.blocks = std::move(blocks);
    if (!section.blocks.empty()) kept.push_back(std::move(section));
  }
  document.sections = std::move(kept);
  return document;
}

std::string no_charts_sentence() {
  return fmt::format("this program was built without the chart library{}{}",
                     why_no_charts().empty() ? "" : ", since ", why_no_charts());
}

}  // namespace

std::string render_html(const Document& document) {
  return render_html(document, has_chart_library());
}

std::string render_html(const Document& complete, bool with_charts) {
  const bool missing = !with_charts && !figures(complete).empty();
  const Document document = missing ? without_figures(complete) : complete;
  const std::vector<const Figure*> all = figures(document);
  const bool charts = !all.empty();
  std::string out = head(document, charts) + top(document) + "<main id=\"content\">\n";
  if (missing)
    out += fmt::format("<p class=\"missing\">This page has no charts: {}. Its tables are complete.</p>\n",
                       html_escape(no_charts_sentence()));
  Numbering numbering;
  for (const Section& section : document.sections) out += section_html(section, numbering);
  out += "</main>\n</div>\n" + footer(charts);
  if (charts) {
    for (const Figure* figure : all) out += render_html_specification(*figure, document.datasets);
    for (const auto& [name, text] : document.datasets) out += render_html_dataset(name, text);
    out += library() + fmt::format("<script>\n{}</script>\n", html_script(web_file("charts.js")));
  }
  out += fmt::format("<script>\n{}</script>\n", html_script(web_file("page.js")));
  return out + "</body>\n</html>\n";
}

}  // namespace odobench
