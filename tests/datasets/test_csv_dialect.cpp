#include "datasets/csv/csv_dialect.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "datasets/csv/csv_stream.hpp"
#include "datasets/csv/csv_table.hpp"
#include "tests/support/data_error.hpp"
#include "tests/support/run_process.hpp"

namespace odobench {
namespace {

using testing::data_error;
using ::testing::ElementsAre;
using testing::says;
using testing::TemporaryFolder;

// Columns a and b of a text, by both readers.
std::vector<double> read(const std::string& text, char usual = ',') {
  const TemporaryFolder folder;
  std::vector<double> values, streamed;
  CsvTable table(text, "t.csv", usual);
  const std::size_t a = table.column("a"), b = table.column("b");
  while (table.next()) values.insert(values.end(), {table.number(a), table.number(b)});
  CsvStream stream(folder.file("t.csv", text), usual);
  while (stream.next())
    streamed.insert(streamed.end(), {stream.number(stream.column("a")), stream.number(stream.column("b"))});
  EXPECT_EQ(values, streamed) << text;
  return values;
}

std::string refusal(const std::string& text) {
  std::string table;
  table = data_error([&] { read(text); });
  return table;
}

TEST(CsvDialect, OneTableInManyHands) {
  const std::vector<double> wanted{1.5, -2, 0.25, 4e3};
  const std::map<std::string, std::string> texts{
      {"plain", "a,b\n1.5,-2\n0.25,4e3\n"},
      {"no final line break", "a,b\n1.5,-2\n0.25,4e3"},
      {"carriage returns", "a,b\r\n1.5,-2\r\n0.25,4e3\r\n"},
      {"carriage returns, no final break", "a,b\r\n1.5,-2\r\n0.25,4e3\r"},
      {"byte order mark",
       "\xEF\xBB\xBF"
       "a,b\n1.5,-2\n0.25,4e3\n"},
      {"blanks", "a, b\n1.5, -2\n 0.25 ,\t4e3 \n"},
      {"semicolons", "a;b\n1.5;-2\n0.25;4e3\n"},
      {"decimal commas", "a;b\n1,5;-2\n0,25;4e3\n"},
      {"decimal commas, tabs", "a\tb\n1,5\t-2\n0,25\t4e3\n"},
      {"tabs", "a\tb\n1.5\t-2\n0.25\t4e3\n"},
      {"columns of blanks", "  a     b\n1.5   -2\n 0.25  4e3  \n"},
      {"quotes", "\"a\",\"b\"\n\"1.5\",-2\n0.25, \"4e3\" \n"},
      {"quoted decimal commas", "\"a\";\"b\"\n\"1,5\";\"-2\"\n\"0,25\";\"4e3\"\n"},
      {"sep=", "sep=;\r\na;b\r\n1,5;-2\r\n0,25;4e3\r\n"},
      {"mark and sep=", "\xEF\xBB\xBFsep=|\na|b\n1.5|-2\n0.25|4e3\n"},
      {"quoted sep=", "\"sep=,\"\na,b\n1.5,-2\n0.25,4e3\n"},
      {"comments", "# a log, of a robot\n#\n\na,b\n1.5,-2\n# pause\n0.25,4e3\n# end\n"},
      {"a comment for a header", "# made today\n# a, b\n1.5,-2\n0.25,4e3\n"},
      {"as rostopic writes it", "%a,b\n1.5,-2\n0.25,4e3\n"},
      {"blank lines at the end", "a,b\n1.5,-2\n0.25,4e3\n\n\r\n"},
      {"a separator at the end of rows", "a,b\n1.5,-2,\n0.25,4e3,\n"},
      {"other columns", "x;\"say \"\"so\"\"; twice\";b;a\n9;\"q;\"\"\";-2;1,5\n9;;4e3;0,25\n"},
  };
  for (const auto& [name, text] : texts) EXPECT_EQ(read(text), wanted) << name;
}

TEST(CsvDialect, MessagesNameTheDialect) {
  EXPECT_TRUE(says(refusal("time;b\n1;2\n"), {"t.csv:1: found no column \"a\"", "read as separated by ';'"}));
  EXPECT_TRUE(says(refusal("time\tb\n1\t2\n"), {"separated by tabs"}));
  EXPECT_TRUE(says(refusal("a|b\n1|2\n"), {"read as one column, \"a|b\"", "; tab and blanks"}));
  EXPECT_TRUE(says(refusal("# made today\nsep,b\n1,2\n"), {"t.csv:2: found no column \"a\""}));
  // German numbers in a file that commas separate.
  EXPECT_TRUE(says(refusal("a,b\n1,5,2,5\n"), {"t.csv:2: found 4 fields, expected 2", "decimal commas"}));
}

TEST(CsvDialect, NumbersOfOneFileAgree) {
  EXPECT_TRUE(
      says(refusal("a;b\n1,5;2\n3;2.5\n"), {"t.csv:3: found \"2.5\" in column \"b\"", "decimal comma"}));
  EXPECT_TRUE(says(refusal("a;b\n1.5;2\n3;2,5\n"), {"t.csv:3: found \"2,5\"", "decimal point"}));
  EXPECT_TRUE(says(refusal("a;b\n1.234,5;2\n"), {"found \"1.234,5\"", "a finite number"}));  // thousands
  EXPECT_TRUE(says(refusal("a;b\n1,234,5;2\n"), {"found \"1,234,5\"", "a finite number"}));
  EXPECT_TRUE(says(refusal("a;b\n;2\n"), {"found \"\" in column \"a\""}));
  EXPECT_TRUE(says(refusal("a,b\nnan,2\n"), {"found \"nan\" in column \"a\", expected a finite number"}));
}

TEST(CsvDialect, WhatIsNoTableIsRefusedInOneLine) {
  EXPECT_TRUE(says(refusal("\xEF\xBB\xBF"), {"t.csv:1: found an empty file, expected a header line"}));
  EXPECT_TRUE(says(refusal("# only\n# comments\n"), {"found an empty file, expected a header line"}));
  EXPECT_TRUE(says(refusal("sep=;\n"), {"found an empty file, expected a header line"}));
  EXPECT_TRUE(says(refusal(std::string("\xFF\xFE"
                                       "a\0,\0b\0\n\0",
                                       10)),
                   {"t.csv:1: found text in UTF-16"}));
  EXPECT_TRUE(says(refusal("a,b\r1,2\r"), {"t.csv:1: found a carriage return inside the line"}));
  EXPECT_TRUE(says(refusal(std::string("\x7F"
                                       "ELF\0\0\n",
                                       7)),
                   {"t.csv:1: found a byte of zero"}));
  EXPECT_TRUE(says(refusal("a,b\n\"1,2\n"), {"t.csv:2: found a quote that is not closed"}));
  EXPECT_TRUE(
      says(refusal("a,b\n\"1\"5,2\n"), {"t.csv:2: found a quote that is not closed, or text behind one"}));
}

// A number cut in two would pass for another one: a last line without a break must at least be whole in its
// fields.
TEST(CsvDialect, ALastLineWithoutABreak) {
  const std::string cut = "found the end of the file inside the line, expected a line break";
  EXPECT_TRUE(says(refusal("a,b\n1,2\n3"), {"t.csv:3: " + cut}));
  EXPECT_TRUE(says(refusal("a,b\n1,2\n3,"), {"t.csv:3: " + cut}));
  EXPECT_TRUE(says(refusal("a,b"), {"t.csv:1: " + cut}));
  CsvTable table("a,b\n1,2\n3,4", "t.csv", ',');
  EXPECT_TRUE(table.next());
  EXPECT_FALSE(table.unfinished());
  EXPECT_TRUE(table.next());
  EXPECT_TRUE(table.unfinished());
  EXPECT_FALSE(table.next());
}

TEST(CsvDialect, LinesAreCountedThroughCommentsAndMarks) {
  CsvTable table("sep=,\n# c\na,b\n1,2\n# d\n3,4\n", "t.csv", ',');
  EXPECT_EQ(table.header_line(), 3u);
  ASSERT_TRUE(table.next());
  EXPECT_EQ(table.line(), 4u);
  ASSERT_TRUE(table.next());
  EXPECT_EQ(table.line(), 6u);
  EXPECT_EQ(table.number(1), 4.0);
}

std::vector<std::string> split(const std::string& line, char separator) {
  std::vector<std::string_view> fields;
  std::deque<std::string> unescaped;
  if (!split_fields(line, separator, fields, unescaped)) return {"not closed"};
  return {fields.begin(), fields.end()};
}

TEST(CsvParts, FieldsOfALine) {
  EXPECT_THAT(split("", ','), ElementsAre(""));
  EXPECT_THAT(split(",", ','), ElementsAre("", ""));
  EXPECT_THAT(split(" \ta b\t ,\t", ','), ElementsAre("a b", ""));
  EXPECT_THAT(split("a\t\tb", '\t'), ElementsAre("a", "", "b"));
  EXPECT_THAT(split(" a \t b ", ' '), ElementsAre("a", "b"));
  EXPECT_THAT(split("\"a;b\";\" c \" ;d", ';'), ElementsAre("a;b", " c ", "d"));
  EXPECT_THAT(split("\"\",\"\"\"\",\"a\"\"b\"", ','), ElementsAre("", "\"", "a\"b"));
  EXPECT_THAT(split("a\"b,\"c\"", ','), ElementsAre("a\"b", "c"));
  for (const char* line : {"\"", "\"a", "a,\"b", "\"a\"b,c", "\"a\"\"", "\"a\" b"})
    EXPECT_THAT(split(line, ','), ElementsAre("not closed")) << line;
}

TEST(CsvParts, TheSeparatorOfAHeader) {
  EXPECT_EQ(find_separator("a", ';'), ';');
  EXPECT_EQ(find_separator(" a ", ';'), ';');
  EXPECT_EQ(find_separator("a b", ';'), ' ');
  EXPECT_EQ(find_separator("a b,c d", ';'), ',');
  EXPECT_EQ(find_separator("a;b,c,d", '|'), ',');
  EXPECT_EQ(find_separator("a;b,c", '|'), ';');  // a tie
  EXPECT_EQ(find_separator("a\tb,c", '|'), '\t');
  EXPECT_EQ(find_separator("\"a,b,c\";\"d,e\"", '|'), ';');
  EXPECT_EQ(CsvDialect{' '}.text(), "separated by blanks");
}

TEST(CsvParts, LinesThatNameTheSeparator) {
  const auto named = [](std::string_view line) {
    char separator = '?';
    return separator_line(line, separator) ? std::string(1, separator) : "none";
  };
  EXPECT_EQ(named("sep=;"), ";");
  EXPECT_EQ(named("SEP=|"), "|");
  EXPECT_EQ(named("\"sep=|\""), "|");
  EXPECT_EQ(named("sep="), "?");
  for (const char* line :
       {"", "\"", "\"\"", "sep", "sep;;", "sep=;;", "sip=;", "seq=;", "fep=;", "\"sep=;", "sep=;\""})
    EXPECT_EQ(named(line), "none") << line;
}

TEST(CsvParts, Comments) {
  const auto behind = [](std::string_view line) {
    std::string_view content;
    return comment_line(line, content) ? std::string(content) : "none";
  };
  EXPECT_EQ(behind("# a, b \t"), "a, b");
  EXPECT_EQ(behind(" \t%a"), "a");
  EXPECT_EQ(behind("#%# a"), "a");
  EXPECT_EQ(behind("##"), "");
  for (const char* line : {"", " ", "a # b"}) EXPECT_EQ(behind(line), "none") << line;
}

TEST(CsvParts, WhatLooksLikeANumber) {
  for (const char* field : {"0", "-1.5", "+1,5", "1e-3", "1.E5", ".5"})
    EXPECT_TRUE(looks_like_number(field)) << field;
  for (const char* field : {"", "-", ".", "e", "e5", "E5", "1x", "a", "1 2", "nan"})
    EXPECT_FALSE(looks_like_number(field)) << field;
}

std::vector<std::string> names(const std::string& text, char usual = ',') {
  return CsvTable(text, "t.csv", usual).names();
}

TEST(CsvDialect, HeadersBelowWhatTheyAreReadWith) {
  EXPECT_THAT(names("sep=;\na,b;c,d\n1;2\n"), ElementsAre("a,b", "c,d"));
  EXPECT_THAT(names("sep=;\n# a,b;c,d\n1;2\n"), ElementsAre("a,b", "c,d"));
  EXPECT_THAT(names("# a;b\n1;2\n"), ElementsAre("a", "b"));
  EXPECT_THAT(names("# a;b\n1,2\n", ';'), ElementsAre("1", "2"));  // as many fields, but by another separator
  EXPECT_THAT(names("# a b c\nx,y\n1,2\n"),
              ElementsAre("x", "y"));  // what it would be read with is forgotten
  EXPECT_THAT(names("# a,b\nx,2\n1,2\n"), ElementsAre("x", "2"));
  EXPECT_THAT(names("# a,b,c\n1,2\n"), ElementsAre("1", "2"));
  EXPECT_THAT(names("a,b\nsep=;,2\n"), ElementsAre("a", "b"));
  CsvTable table("# made\n# a,b\n1,2\n3,4\n", "t.csv", ',');
  EXPECT_EQ(table.header_line(), 2u);
  EXPECT_TRUE(table.dialect().comment_header);
  ASSERT_TRUE(table.next());
  EXPECT_EQ(table.number(0), 1);
  EXPECT_EQ(table.line(), 3u);
  ASSERT_TRUE(table.next());
  EXPECT_EQ(table.number(1), 4);
  EXPECT_EQ(table.line(), 4u);
  EXPECT_FALSE(table.next());
  EXPECT_EQ(table.reading(), " (read as separated by ',', header in a comment)");
}

TEST(CsvDialect, ColumnsAreNamedOnce) {
  CsvTable table("a,b,a,c\n1,2,3,4\n", "t.csv", ',');
  EXPECT_EQ(table.column("b"), 1u);
  EXPECT_EQ(table.column("c"), 3u);
  EXPECT_EQ(data_error([&] { table.column("a"); }), "t.csv:1: found two columns \"a\", expected one");
  EXPECT_EQ(
      data_error([&] { table.column("d"); }),
      "t.csv:1: found no column \"d\", expected it among the 4 of the header (read as separated by ',')");
}

TEST(CsvDialect, NumbersAtTheirLimits) {
  const auto number = [](const std::string& field) {
    const std::string text = "a;b\n" + field + ";0\n";
    CsvTable table(text, "t.csv", ';');
    table.next();
    return table.number(0);
  };
  const auto error = [&](const std::string& field) { return data_error([&] { number(field); }); };
  EXPECT_EQ(number("+1.5"), 1.5);
  EXPECT_EQ(number("+0"), 0);
  EXPECT_EQ(number("-1e50"), -1e50);
  EXPECT_EQ(number("0," + std::string(61, '0') + "1"), 1e-62);  // 64 characters
  EXPECT_EQ(error("0," + std::string(62, '0') + "1").substr(0, 16), "t.csv:2: found \"");
  EXPECT_EQ(error("1.1e50"),
            "t.csv:2: found \"1.1e50\" in column \"a\", expected a number of at most 1e+50 in size");
  for (const char* field : {"", "+", "+-1", "++1", "1 2", "inf", "1e999", "1x", "x1"}) {
    EXPECT_EQ(error(field),
              fmt::format("t.csv:2: found \"{}\" in column \"a\", expected a finite number", field));
  }
  CsvTable table("a;b\n1;2,5\n3;4\n5;6.5\n", "t.csv", ';');
  for (int row = 0; row < 3; ++row) {
    table.next();
    EXPECT_EQ(table.number(0), 1 + 2 * row);
    if (row < 2) {
      EXPECT_EQ(table.number(1), row == 0 ? 2.5 : 4);
    }
  }
  EXPECT_EQ(data_error([&] { table.number(1); }),
            "t.csv:4: found \"6.5\" in column \"b\", expected a decimal comma as in the numbers before it");
  EXPECT_EQ(table.reading(), " (read as separated by ';', decimal comma)");
}

}  // namespace
}  // namespace odobench
