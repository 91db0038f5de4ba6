// Pages of reports: that nothing in them is read as markup, that numbers keep their digits, that nothing is
// fetched.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <regex>

#include "reports/figures/document.hpp"
#include "reports/page/html_figure.hpp"
#include "reports/page/html_table.hpp"
#include "reports/page/html_text.hpp"
#include "reports/page/web_assets.hpp"
#include "tests/support/data/sample_document.hpp"

namespace odobench {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t found = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + what.size()))
    ++found;
  return found;
}

std::string row_of(double value, int precision) {
  Table table;
  table.id = "t";
  table.columns.resize(2);
  table.rows = {{text_cell("name"), fixed_cell(value, precision)}};
  return render_html_table(table, "t", 1);
}

std::string attribute(const std::string& html, const std::string& name) {
  const std::string begin = " " + name + "=\"";
  const std::size_t at = html.find(begin);
  if (at == std::string::npos) return "";
  const std::size_t from = at + begin.size();
  return html.substr(from, html.find('"', from) - from);
}

// A page of tables only: what it takes before data and charts.
Document tables_only() {
  Document document;
  document.title = "A < B & \"C\"";
  document.subtitle = "</title><script>alert(1)</script>";
  document.sections = {
      {"one", "One & only", "<b>lead</b>", {Paragraph{"<i>text</i>"}, testing::sample_table()}}};
  return document;
}

TEST(HtmlText, NothingIsMarkup) {
  EXPECT_EQ(html_escape("<a href=\"x\">'&'</a>"), "&lt;a href=&quot;x&quot;&gt;&#39;&amp;&#39;&lt;/a&gt;");
}

TEST(HtmlText, OneLetterWithAnIndexIsASymbol) {
  EXPECT_EQ(html_symbol("e_x,max"), "<i>e</i><sub>x,max</sub>");
  EXPECT_EQ(html_symbol("σ_x"), "<i>σ</i><sub>x</sub>");
  EXPECT_EQ(html_symbol("max_evaluations"), "max_evaluations");
  EXPECT_EQ(html_symbol("e_max of x"), "e_max of x");
  EXPECT_EQ(html_symbol("e_<b>"), "<i>e</i><sub>&lt;b&gt;</sub>");
}

TEST(HtmlText, JsonCannotEndItsElement) {
  const std::string text = html_json({{"</script><!--", "<\xff"}});
  EXPECT_THAT(text, Not(HasSubstr("<")));
  EXPECT_TRUE(nlohmann::json::parse(text).contains("</script><!--"));
}

TEST(HtmlText, ProgramsCannotEndTheirElement) {
  EXPECT_EQ(html_script("a='</script>';b='<!--'"), "a='<\\/script>';b='<\\!--'");
}

TEST(HtmlTable, NumbersKeepEveryBit) {
  for (const double value :
       {0.1 + 0.2, 1.0 / 3, -1e-300, 4.9406564584124654e-324, 1.7976931348623157e308, -0.0, 123456789.125}) {
    const std::string digits = attribute(row_of(value, 3), "data-value");
    const double read = std::strtod(digits.c_str(), nullptr);
    EXPECT_EQ(read, value) << digits;
    EXPECT_EQ(std::signbit(read), std::signbit(value)) << digits;
  }
  EXPECT_NE(std::strtod(attribute(row_of(0.1 + 0.2, 3), "data-value").c_str(), nullptr), 0.3);
}

TEST(HtmlTable, WhatIsNotFiniteIsSaid) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(attribute(row_of(std::nan(""), 3), "data-value"), "nan");
  EXPECT_EQ(attribute(row_of(infinity, 3), "data-value"), "inf");
  EXPECT_EQ(attribute(row_of(-infinity, 3), "data-value"), "-inf");
}

TEST(HtmlTable, ShowsNumberDifferenceAndMark) {
  const std::string html = render_html_table(testing::sample_table(), "t", 4);
  EXPECT_THAT(html,
              AllOf(HasSubstr(">118.125<span class=\"tail\""), HasSubstr("(+5.625)</span> U</span>"),
                    HasSubstr("data-value=\"118.125\" data-difference=\"5.625\""), HasSubstr("Table 4.")));
  EXPECT_THAT(row_of(-1.5, 2), HasSubstr("\u22121.50"));
}

TEST(HtmlTable, TextOfCellsColumnsAndNotesIsEscaped) {
  const std::string html = render_html_table(testing::sample_table(), "t", 1);
  EXPECT_THAT(html, AllOf(HasSubstr("&lt;i&gt;text&lt;/i&gt;"), HasSubstr("[m&lt;2&gt;]"),
                          HasSubstr("hard &lt;cells&gt;"), HasSubstr("A note with &lt;script&gt;"),
                          Not(HasSubstr("<script"))));
}

TEST(HtmlTable, RefusesARowOfAnotherLength) {
  Table table = testing::sample_table();
  table.rows[2].pop_back();
  try {
    render_html_table(table, "t", 1);
    FAIL() << "a short row was accepted";
  } catch (const std::invalid_argument& e) {
    EXPECT_THAT(e.what(),
                AllOf(HasSubstr("hard <cells>"), HasSubstr("row 3"), HasSubstr("2 cells, expected 3")));
  }
}

TEST(HtmlPage, WithoutChartsIsSmallAndComplete) {
  const std::string html = render_html(tables_only());
  EXPECT_LT(html.size(), 40'000u);
  EXPECT_THAT(html,
              AllOf(HasSubstr("<title>A &lt; B &amp; &quot;C&quot;</title>"),
                    HasSubstr("<h2 id=\"one-title\">One &amp; only</h2>"),
                    HasSubstr("<a href=\"#one\">One &amp; only</a>"), HasSubstr("&lt;b&gt;lead&lt;/b&gt;"),
                    HasSubstr("&lt;i&gt;text&lt;/i&gt;"), Not(HasSubstr("<script>alert"))));
  EXPECT_EQ(count(html, "<table "), 1u);
  EXPECT_THAT(html, Not(HasSubstr("are missing")));
}

TEST(HtmlPage, FetchesNothing) {
  for (const std::string& html : {render_html(tables_only()), render_html(testing::sample_document())}) {
    const std::string page = html.substr(0, html.find("<footer>"));
    EXPECT_THAT(page, HasSubstr("default-src 'none'"));
    EXPECT_FALSE(
        std::regex_search(page, std::regex(R"(<link|<iframe|<img|@import|url\(|\ssrc=|href="[^#])")));
    EXPECT_EQ(count(html, "</html>"), 1u);
  }
  EXPECT_THAT(render_html(tables_only()), Not(HasSubstr("unsafe-eval")));
}

// What is not there is said once, with the reason, and not counted.
TEST(HtmlPage, FiguresAreDrawnOrSaidToBeMissing) {
  const Document document = testing::sample_document();
  for (const bool charts : {true, false}) {
    const std::string html = render_html(document, charts);
    EXPECT_EQ(count(html, "<figure "), charts ? figures(document).size() : 0u);
    EXPECT_EQ(count(html, "<table "), 3u);
    EXPECT_EQ(count(html, "<script type=\"application/json\" data-dataset=\""),
              charts ? document.datasets.size() : 0u);
    EXPECT_EQ(count(html, "This page has no charts: this program was built without the chart library"),
              charts ? 0u : 1u);
    for (const Figure* figure : figures(document))
      EXPECT_EQ(html.find("figure-" + figure->id) != std::string::npos, charts) << figure->id;
    EXPECT_EQ(html.find("Redistribution and use in source and binary forms") != std::string::npos,
              charts && has_chart_library());
  }
  EXPECT_EQ(why_no_charts().empty(), has_chart_library());
}

TEST(HtmlPage, AFigureWithoutItsDataIsRefused) {
  const Document document = testing::sample_document();
  try {
    render_html_specification(*figures(document).front(), {});
    FAIL() << "a figure without data was accepted";
  } catch (const std::invalid_argument& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr("path.circle"), HasSubstr("'tracks'")));
  }
}

TEST(HtmlPage, HeightsOfChartsAreAboutRight) {
  EXPECT_EQ(estimated_height({{"mark", "line"}, {"height", 300}}), 345);
  const nlohmann::json view{{"mark", "line"}, {"height", 100}};
  EXPECT_EQ(estimated_height({{"vconcat", {view, view}}}), 290);
  EXPECT_EQ(estimated_height({{"hconcat", {view, view}}}), 145);
  EXPECT_EQ(estimated_height({{"concat", {view, view, view}}, {"columns", 2}}), 290);
}

TEST(WebAssets, UnknownFilesAreRefused) {
  EXPECT_THROW(web_file("page.html"), std::invalid_argument);
  EXPECT_THAT(std::string(web_file("page.css")), HasSubstr("@media print"));
}

}  // namespace
}  // namespace odobench
