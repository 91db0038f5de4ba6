// Tables and their renderings.
#include <gmock/gmock.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "reports/render/cell_text.hpp"
#include "reports/render/table.hpp"
#include "reports/render/text_width.hpp"

namespace odobench {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::ThrowsMessage;

constexpr double kInf = std::numeric_limits<double>::infinity();

// Everything that renderers get wrong: separators, quotes, wide and combining letters, characters with a
// meaning in LaTeX and Markdown, negative zero, missing cells, differences, marks.
Table difficult_table() {
  Table table;
  table.id = "difficult";
  table.title = "A, \"B\" & 50 % of a_b";
  Column name{"set", "set", "", "", "", Align::Left};
  Column value{"e_max", "e_θ,max", "m", "$e_{\\theta,\\max}$", ""};
  value.mark_name = "bound";
  Column note{"note", "note", "", "", "", Align::Left};
  table.columns = {name, value, note};
  Cell both = fixed_cell(0.063233175394, 6);
  both.difference = -0.0123449;
  both.mark = "U";
  Cell zero = fixed_cell(-0.0, 6);
  zero.difference = 1e-9;
  table.rows = {{text_cell("lm, \"x\""), both, text_cell("a|b <c> #1 $2$ ^~{}\\")},
                {text_cell("Žofie 線"), zero, Cell{}},
                {text_cell("[p]"), significant_cell(-2.11e-9, 3), text_cell("two\nlines")},
                {text_cell("none"), Cell{}, text_cell("_x_")}};
  table.notes = {"100 % of it, \"quoted\""};
  return table;
}

Table wide_table() {
  Table table;
  table.id = table.title = "wide";
  table.columns = {Column{"key", "key", "", "", "", Align::Left}};
  std::vector<Cell> row{text_cell("row")};
  for (const char* group : {"x", "y", "z"})
    for (const char* name : {"1", "2", "3"}) {
      table.columns.push_back({std::string(group) + name, std::string(group) + name, "m", "", group});
      row.push_back(fixed_cell(123.456789, 6));
    }
  table.columns.push_back({"text", "text", "", "", "", Align::Left});
  row.push_back(text_cell("a sentence of some length that may be wrapped where there is no room for it"));
  table.rows = {row};
  return table;
}

// Rows a, b, c, d; the first is a reference.
Table ranking(Better better, const std::vector<double>& values) {
  Table table{"r", "r", {{"key", "key", "", "", "", Align::Left}, best_if(better, {"v", "v", "", "", ""})},
              {},  {},  {0}};
  for (std::size_t i = 0; i < values.size(); ++i)
    table.rows.push_back({text_cell(std::string(1, static_cast<char>('a' + i))), fixed_cell(values[i], 2)});
  return table;
}

TEST(NumberText, FixedAndSignificant) {
  EXPECT_EQ(number_text(0.0632331, Notation::Fixed, 6), "0.063233");
  EXPECT_EQ(number_text(-0.0123449, Notation::Fixed, 6, true), "-0.012345");
  EXPECT_EQ(number_text(0.0123449, Notation::Fixed, 6, true), "+0.012345");
  EXPECT_EQ(number_text(98.11878293011678, Notation::Significant, 10), "98.11878293");
  EXPECT_EQ(number_text(2.114e-9, Notation::Significant, 3), "2.11e-09");
  EXPECT_EQ(number_text(1e20, Notation::Fixed, 3), "1e+20");
  EXPECT_EQ(number_text(12, Notation::Fixed, 0), "12");
}

TEST(NumberText, ZeroHasNoSign) {
  EXPECT_EQ(number_text(-0.0, Notation::Fixed, 6), "0.000000");
  EXPECT_EQ(number_text(-4e-7, Notation::Fixed, 6), "0.000000");
  EXPECT_EQ(number_text(4e-7, Notation::Fixed, 6, true), "0.000000");
  EXPECT_EQ(number_text(-6e-7, Notation::Fixed, 6), "-0.000001");
  EXPECT_EQ(number_text(-0.0, Notation::Significant, 6), "0");
}

TEST(NumberText, NonFinite) {
  EXPECT_EQ(number_text(kInf, Notation::Fixed, 6), "inf");
  EXPECT_EQ(number_text(-kInf, Notation::Significant, 6), "-inf");
  EXPECT_EQ(number_text(std::numeric_limits<double>::quiet_NaN(), Notation::Fixed, 6, true), "nan");
  EXPECT_EQ(number_text(-std::numeric_limits<double>::quiet_NaN(), Notation::Fixed, 6), "nan");
}

TEST(TextWidth, CountsCellsNotBytes) {
  EXPECT_EQ(display_width("abc"), 3);
  EXPECT_EQ(display_width("θ–Σ"), 3);
  EXPECT_EQ(display_width("e\u0301"), 1);
  EXPECT_EQ(display_width("線形"), 4);
  EXPECT_EQ(display_width("\xff\xc3"), 2) << "a broken byte is one cell";
  EXPECT_EQ(pad_left("θ", 3), "  θ");
  EXPECT_EQ(pad_right("線", 3), "線 ");
  EXPECT_EQ(pad_left("long", 2), "long");
}

TEST(TextWidth, WrapsAtSpacesThenCommasThenAnywhere) {
  EXPECT_THAT(wrap_text("one two three", 7), ElementsAre("one two", "three"));
  EXPECT_THAT(wrap_text("pso[swarm=60,inertia=0.7]", 14), ElementsAre("pso[swarm=60,", "inertia=0.7]"));
  EXPECT_THAT(wrap_text("abcdefgh", 3), ElementsAre("abc", "def", "gh"));
  EXPECT_THAT(wrap_text("θθθθ", 2), ElementsAre("θθ", "θθ"));
  EXPECT_THAT(wrap_text("線線", 3), ElementsAre("線", "線"));
  EXPECT_THAT(wrap_text("a\nb c", 9), ElementsAre("a", "b c"));
  EXPECT_THAT(wrap_text("", 9), ElementsAre(""));
  EXPECT_THAT(wrap_text("  spaces  ", 9), ElementsAre("spaces"));
  EXPECT_THAT(wrap_text("a    b", 3), ElementsAre("a", "b"));
}

TEST(Format, NamesBothWays) {
  for (const char* name : {"console", "md", "csv", "json", "latex"})
    EXPECT_EQ(to_string(parse_format(name)), name);
  EXPECT_EQ(file_extension(Format::Console), "txt");
  EXPECT_EQ(file_extension(Format::Latex), "tex");
  EXPECT_THAT([] { parse_format("html"); },
              ThrowsMessage<std::invalid_argument>(
                  "unknown table format 'html', expected console, md, csv, json or latex"));
  EXPECT_THROW(parse_format(""), std::invalid_argument);
  EXPECT_THROW(parse_format("CSV"), std::invalid_argument);
}

TEST(Render, RefusesRaggedTables) {
  Table table = difficult_table();
  table.rows[1].pop_back();
  EXPECT_THAT([&] { render({table}, Format::Csv); },
              ThrowsMessage<std::invalid_argument>("table 'difficult': row 2 has 2 cells, expected 3"));
  table = difficult_table();
  table.columns[2].id = "set";
  EXPECT_THAT([&] { render({table}, Format::Json); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("two columns with the id 'set'")));
  EXPECT_THROW(render({Table{}}, Format::Console), std::invalid_argument);
}

TEST(Render, NoTables) {
  EXPECT_EQ(render({}, Format::Console), "");
  EXPECT_EQ(render({}, Format::Csv), "");
  EXPECT_EQ(render({}, Format::Latex), "");
  EXPECT_EQ(nlohmann::json::parse(render({}, Format::Json)).at("tables").size(), 0u);
}

TEST(Render, Console) {
  EXPECT_EQ(render({difficult_table()}, Format::Console), R"(A, "B" & 50 % of a_b
───────────────────────────────────────────────────────
set                       e_θ,max  note
                              [m]
───────────────────────────────────────────────────────
lm, "x"    0.063233 (-0.012345) U  a|b <c> #1 $2$ ^~{}\
Žofie 線   0.000000 (0.000000)     –
[p]       -2.11e-09                two lines
none              –                _x_
───────────────────────────────────────────────────────
100 % of it, "quoted"
)");
}

TEST(Render, Markdown) {
  EXPECT_EQ(render({difficult_table()}, Format::Markdown), R"(### A, "B" & 50 % of a_b

| set | e_θ,max [m] | note |
| :--- | ---: | :--- |
| lm, "x" | 0.063233 (-0.012345) U | a\|b \<c> #1 \$2\$ ^\~{}\\ |
| Žofie 線 | 0.000000 (0.000000) | – |
| [p] | -2.11e-09 | two lines |
| none | – | \_x\_ |

- 100 % of it, "quoted"
)");
}

TEST(Render, Latex) {
  EXPECT_EQ(render({difficult_table()}, Format::Latex),
            R"(% \usepackage[T1]{fontenc}
% \usepackage{array, booktabs, graphicx}
% \usepackage{siunitx}  % version 3
\begin{table}[htbp]
\centering
\caption{A, \textquotedbl{}B\textquotedbl{} \& 50 \% of a\_b}
\label{tab:difficult}
\par\smallskip
\small\setlength{\tabcolsep}{4pt}
\sisetup{mode=text, reset-text-series=false, group-digits=none, table-align-exponent=false}
\resizebox{\ifdim\width>\linewidth\linewidth\else\width\fi}{!}{%
\begin{tabular}{lS[table-format=-1.6e-1]@{\,}r@{\,}ll}
\toprule
set & \multicolumn{3}{c}{$e_{\theta,\max}$} & note \\
 & \multicolumn{3}{c}{[\unit{\metre}]} &  \\
\midrule
lm, \textquotedbl{}x\textquotedbl{} & 0.063233 & $(-0.012345)$ & U & a\textbar{}b \textless{}c\textgreater{} \#1 \$2\$ \textasciicircum{}\textasciitilde{}\{\}\textbackslash{} \\
Žofie 線 & 0.000000 & $(0.000000)$ & & -- \\
{}[p] & -2.11e-9 & & & two lines \\
none & {--} & & & \_x\_ \\
\bottomrule
\end{tabular}}
\par\smallskip
\begin{minipage}{\linewidth}\footnotesize\raggedright
100 \% of it, \textquotedbl{}quoted\textquotedbl{}\par
\end{minipage}
\end{table}
)");
}

TEST(Render, LatexNonFinite) {
  Table table = difficult_table();
  table.rows = {{text_cell("θ ≤ σ"), fixed_cell(kInf, 3), Cell{}},
                {text_cell("b"), fixed_cell(-kInf, 3), Cell{}},
                {text_cell("c"), fixed_cell(12, 3), Cell{}}};
  const std::string text = render({table}, Format::Latex);
  EXPECT_THAT(text, HasSubstr("$\\theta$ $\\leq$ $\\sigma$ & {$\\infty$} &"));
  EXPECT_THAT(text, HasSubstr("b & {$-\\infty$} &"));
  EXPECT_THAT(text, HasSubstr("S[table-format=2.3]"));
}

TEST(Render, LatexGroupsAndBlocks) {
  Table table = wide_table();
  for (std::size_t c = 1; c < 10; ++c) table.columns[c].name = "v";  // else the names say the group
  const std::string text = render({table}, Format::Latex);
  EXPECT_THAT(text,
              HasSubstr("\\multicolumn{1}{c}{} & \\multicolumn{3}{c}{$x$} & \\multicolumn{3}{c}{$y$} \\\\\n"
                        "\\cmidrule(lr){2-4}\\cmidrule(lr){5-7}\n"));
  EXPECT_THAT(text, HasSubstr("\\multicolumn{3}{c}{z}"));
  EXPECT_THAT(text, HasSubstr("\\par\\medskip")) << "too wide for a line: two blocks";
  EXPECT_EQ(text.find("\\caption"), text.rfind("\\caption"));
  std::size_t numbers = 0;
  for (std::size_t at = text.find("123.456789"); at != std::string::npos;
       at = text.find("123.456789", at + 1))
    ++numbers;
  EXPECT_EQ(numbers, 9u) << "no cell lost";
  for (int i = 0; i < 100; ++i) table.rows.push_back(table.rows.front());
  const std::string pages = render({table}, Format::Latex);
  EXPECT_THAT(pages, HasSubstr("\\caption[]{wide, continued}"));
  EXPECT_EQ(pages.find("\\label"), pages.rfind("\\label"));
  EXPECT_THAT(render({ranking(Better::Lower, {9, 3, 1, 2})}, Format::Latex),
              HasSubstr("c & \\bfseries 1.00 \\\\"));
}

// An independent reader: RFC 4180, section 2.
std::vector<std::vector<std::string>> parse_csv(const std::string& text) {
  std::vector<std::vector<std::string>> lines{{""}};
  bool inside = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (inside && text[i] == '"' && i + 1 < text.size() && text[i + 1] == '"') {
      lines.back().back() += '"';
      ++i;
    } else if (text[i] == '"') {
      inside = !inside;
    } else if (!inside && text[i] == ',') {
      lines.back().emplace_back();
    } else if (!inside && text.compare(i, 2, "\r\n") == 0) {
      lines.push_back({""});
      ++i;
    } else {
      lines.back().back() += text[i];
    }
  }
  EXPECT_FALSE(inside);
  EXPECT_THAT(lines.back(), ElementsAre("")) << "ends with a line break";
  lines.pop_back();
  return lines;
}

TEST(Render, Csv) {
  Table second = difficult_table();
  second.id = "second";
  second.notes.clear();
  second.rows = {{text_cell("x"), fixed_cell(1.0 / 3, 1), Cell{}}};
  const auto lines = parse_csv(render({difficult_table(), second}, Format::Csv));
  ASSERT_EQ(lines.size(), 7u + 1 + 3);
  EXPECT_THAT(lines[0], ElementsAre("#table", "difficult", "A, \"B\" & 50 % of a_b"));
  EXPECT_THAT(lines[1], ElementsAre("set", "e_max [m]", "e_max_difference [m]", "e_max_bound", "note"));
  EXPECT_THAT(lines[2],
              ElementsAre("lm, \"x\"", "0.063233175394", "-0.0123449", "U", "a|b <c> #1 $2$ ^~{}\\"));
  EXPECT_THAT(lines[3], ElementsAre("Žofie 線", "-0", "1e-09", "", ""));
  EXPECT_THAT(lines[4], ElementsAre("[p]", "-2.11e-09", "", "", "two\nlines"));
  EXPECT_THAT(lines[5], ElementsAre("none", "", "", "", "_x_"));
  EXPECT_THAT(lines[6], ElementsAre("#note", "100 % of it, \"quoted\""));
  EXPECT_THAT(lines[7], ElementsAre(""));
  EXPECT_THAT(lines[8], ElementsAre("#table", "second", "A, \"B\" & 50 % of a_b"));
  EXPECT_THAT(lines[9], ElementsAre("set", "e_max [m]", "note"));
  EXPECT_EQ(std::stod(lines[10][1]), 1.0 / 3) << "all digits";
}

TEST(Render, Json) {
  Table table = difficult_table();
  table.rows.push_back({text_cell("bad \xff"), fixed_cell(kInf, 3), Cell{}});
  table.rows.push_back({text_cell("n"), count_cell(50000), Cell{}});
  const std::string text = render({table}, Format::Json);
  const auto json = nlohmann::json::parse(text);
  EXPECT_EQ(json.at("schema_version"), 1);
  const auto& out = json.at("tables").at(0);
  EXPECT_EQ(out.at("id"), "difficult");
  EXPECT_EQ(out.at("columns").at(1), (nlohmann::json{{"id", "e_max"}, {"name", "e_θ,max"}, {"unit", "m"}}));
  const auto& rows = out.at("rows");
  EXPECT_EQ(rows.at(0).at("e_max"),
            (nlohmann::json{{"value", 0.063233175394}, {"difference", -0.0123449}, {"bound", "U"}}));
  EXPECT_EQ(rows.at(0).at("set"), "lm, \"x\"");
  EXPECT_TRUE(std::signbit(rows.at(1).at("e_max").at("value").get<double>()));
  EXPECT_TRUE(rows.at(1).at("note").is_null());
  EXPECT_EQ(rows.at(2).at("e_max"), -2.11e-9);
  EXPECT_TRUE(rows.at(4).at("e_max").is_null());
  EXPECT_TRUE(rows.at(5).at("e_max").is_number_integer());
  EXPECT_EQ(rows.at(5).at("e_max"), 50000);
  EXPECT_EQ(out.at("notes").at(0), "100 % of it, \"quoted\"");
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

TEST(Console, NeverWiderThanTheTerminal) {
  for (int width = 40; width < 240; ++width) {
    const std::string text = render({wide_table()}, Format::Console, {width});
    for (const std::string& line : lines_of(text)) {
      ASSERT_LE(display_width(line), width) << text;
      ASSERT_THAT(line, Not(::testing::EndsWith(" ")));
    }
    std::size_t numbers = 0;
    for (std::size_t at = text.find("123.456789"); at != std::string::npos;
         at = text.find("123.456789", at + 1))
      ++numbers;
    ASSERT_EQ(numbers, 9u) << "no cell lost at width " << width;
  }
}

TEST(Console, WrapsTextFirstThenSplitsBetweenGroups) {
  // 3 + 9 * (2 + 10) + 2 + 75 cells.
  EXPECT_EQ(lines_of(render({wide_table()}, Format::Console, {188})).size(), 7u);
  EXPECT_EQ(lines_of(render({wide_table()}, Format::Console, {0})).size(), 7u);
  EXPECT_EQ(lines_of(render({wide_table()}, Format::Console, {187})).size(), 8u) << "two lines of text";
  const std::string split = render({wide_table()}, Format::Console, {50});
  EXPECT_THAT(split, HasSubstr("key          x1          x2          x3\n"));
  EXPECT_THAT(split, HasSubstr("key          y1          y2          y3\n"));
  EXPECT_THAT(split, HasSubstr("key          z1          z2          z3\n"));
  // Too narrow for a group: cut inside, still one key per block.
  EXPECT_THAT(render({wide_table()}, Format::Console, {30}), HasSubstr("key          x1          x2\n"));
}

std::string best_rows(Table table) {
  mark_best(table);
  std::string out;
  for (const auto& row : table.rows)
    if (row[1].best) out += row[0].text;
  return out;
}

TEST(Best, LowestOrHighestOfTheRowsThatCompete) {
  EXPECT_EQ(best_rows(ranking(Better::Lower, {9, 3, 1, 2})), "c");
  EXPECT_EQ(best_rows(ranking(Better::Higher, {0, 3, 1, 2})), "b");
  EXPECT_EQ(best_rows(ranking(Better::None, {9, 3, 1, 2})), "");
  EXPECT_EQ(best_rows(ranking(Better::Lower, {9, 1.001, 1.004, 2})), "bc") << "they read the same";
  EXPECT_EQ(best_rows(ranking(Better::Lower, {9, 2, 2, 2})), "") << "no best among equals";
  EXPECT_EQ(best_rows(ranking(Better::Lower, {9, 2})), "") << "only one competes";
  EXPECT_EQ(best_rows(ranking(Better::Lower, {9, std::nan(""), 2, -kInf, 3})), "c") << "finite ones only";
}

Table ranked_with_noise(const std::vector<double>& values, const std::vector<double>& noise) {
  Table table = ranking(Better::Lower, values);
  for (std::size_t i = 0; i < noise.size(); ++i) table.rows[i][1].noise = noise[i];
  return table;
}

TEST(Best, NothingIsBestThatIsNotBetterThanNominal) {
  EXPECT_EQ(best_rows(ranking(Better::Lower, {1, 1.5, 1.2, 2})), "");
  EXPECT_EQ(best_rows(ranking(Better::Lower, {1, 1.5, 1, 2})), "");
  EXPECT_EQ(best_rows(ranking(Better::Lower, {1, 1.5, 0.9, 2})), "c");
}

TEST(Best, ALeadMustExceedTheNoise) {
  EXPECT_EQ(best_rows(ranked_with_noise({9, 3, 1, 2}, {0, 0, 0.5, 0})), "c");
  EXPECT_EQ(best_rows(ranked_with_noise({9, 3, 1, 2}, {0, 0, 1.5, 0})), "cd")
      << "d is within the noise of c, b is not";
  EXPECT_EQ(best_rows(ranked_with_noise({9, 3, 1, 2}, {0, 0, 2.5, 0})), "");
  EXPECT_EQ(best_rows(ranked_with_noise({9, 3, 1, 2}, {0, 0, kInf, 0})), "")
      << "a single run of something random";
  // Of numbers that differ by rounding the one that repeats speaks for all.
  EXPECT_EQ(best_rows(ranked_with_noise({9, 3, 1, 1 + 1e-12}, {0, 0, kInf, 0})), "cd");
}

TEST(Best, WhatIsWorseThanNominalIsMarkedEverywhere) {
  Table table = ranking(Better::Lower, {1, 1.5, 0.9, kInf});
  table.rows[1][1].difference = 0.5;
  const std::string console = render({table}, Format::Console);
  EXPECT_THAT(console, HasSubstr("b    1.50 (+0.50) !\n"));
  EXPECT_THAT(console, HasSubstr("d     inf !\n"));
  EXPECT_THAT(console, HasSubstr("!: worse than a.\n"));
  EXPECT_THAT(render({table}, Format::Markdown), HasSubstr("| b | 1.50 (+0.50) ! |"));
  EXPECT_THAT(render({table}, Format::Markdown), HasSubstr("!: worse than a."));
  EXPECT_THAT(render({table}, Format::Latex), HasSubstr("!"));
  EXPECT_THAT(render({table}, Format::Latex), HasSubstr("!: worse than a."));
  EXPECT_THAT(render({table}, Format::Json), Not(HasSubstr("worse")));
  EXPECT_THAT(render({ranked_with_noise({1, 1.5, 0.9, 2}, {0, 1, 0, 2})}, Format::Console),
              Not(HasSubstr("!")));
  EXPECT_THAT(render({ranking(Better::Higher, {1, 1.5, 0.9, 2})}, Format::Console), HasSubstr("c    0.90 !"));
  EXPECT_THAT(render({ranked_with_noise({1, 1.5, 0.9, 2}, {0, kInf, 0, 0})}, Format::Console),
              HasSubstr("b    1.50 !"))
      << "a single run of something random: its result is worse all the same";
}

TEST(Best, EveryFormatForPeopleShowsIt) {
  Table table = ranking(Better::Lower, {9, 3, 1, 2});
  table.rows[1][1].difference = 2;
  EXPECT_EQ(render({table}, Format::Console), R"(r
─────────────────
key             v
─────────────────
a    9.00
b    3.00 (+2.00)
c    1.00 *
d    2.00
─────────────────
*: best of its column.
)");
  EXPECT_THAT(render({table}, Format::Console, {80, true}),
              HasSubstr("c    \x1b[1m1.00\x1b[0m\nd    2.00\n─────────────────\n"));
  EXPECT_THAT(render({table, table}, Format::Console, {80, true}), Not(HasSubstr("best of")));
  const std::string twice = render({table, table}, Format::Console);
  EXPECT_EQ(twice.find("best of"), twice.rfind("best of")) << "explained once";
  EXPECT_THAT(render({table}, Format::Markdown), HasSubstr("| b | 3.00 (+2.00) |\n| c | **1.00** |\n"));
  const Table plain = ranking(Better::None, {9, 3, 1, 2});
  table.rows[1][1].difference.reset();
  EXPECT_EQ(render({table}, Format::Csv), render({plain}, Format::Csv));
  EXPECT_EQ(render({table}, Format::Json), render({plain}, Format::Json));
}

}  // namespace
}  // namespace odobench
