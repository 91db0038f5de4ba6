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

// A number cut in two would pass for another one: a last line without a break must at least be whole in its fields.
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

}  // namespace
}  // namespace odobench
