#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "tests/support/logs.hpp"

namespace odobench {
namespace {

using testing::data_error;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::open_log;
using testing::read_log;
using testing::request;
using testing::says;
using testing::sum_of;
using testing::TemporaryFolder;
using testing::usage_error;

const std::string kMark = "\xEF\xBB\xBF";

LogTable read(const std::string& text, const LogRequest& wanted, const LogOptions& options = {}) {
  const TemporaryFolder folder;
  return read_log(folder.file("log.csv", text), wanted, options);
}

std::vector<LogSource> sources(const std::string& text, const LogOptions& options = {}) {
  const TemporaryFolder folder;
  return open_log(folder.file("log.csv", text), options)->sources(Stop());
}

std::vector<std::string> names(const std::string& text) {
  std::vector<std::string> paths;
  const LogSource source = sources(text).at(0);
  for (const LogField& field : source.fields) paths.push_back(field.path);
  return paths;
}

TEST(CsvLog, OneTableInManyHands) {
  const std::map<std::string, std::string> texts{
      {"plain", "t_ms,a,b\n10,1.5,-2\n20,0.25,4e3\n30,-7,0.125\n"},
      {"no final line break", "t_ms,a,b\n10,1.5,-2\n20,0.25,4e3\n30,-7,0.125"},
      {"CRLF, mark", kMark + "t_ms,a,b\r\n10,1.5,-2\r\n20,0.25,4e3\r\n30,-7,0.125\r\n"},
      {"blanks behind commas", "t_ms, a, b\n10, 1.5, -2\n20, 0.25, 4e3\n30, -7, 0.125\n"},
      {"semicolons, decimal commas", "t_ms;a;b\n10;1,5;-2\n20;0,25;4e3\n30;-7;0,125\n"},
      {"tabs", "t_ms\ta\tb\n10\t1.5\t-2\n20\t0.25\t4e3\n30\t-7\t0.125\n"},
      {"tabs, decimal commas", "t_ms\ta\tb\n10\t1,5\t-2\n20\t0,25\t4e3\n30\t-7\t0,125\n"},
      {"bars", "t_ms|a|b\n10|1.5|-2\n20|0.25|4e3\n30|-7|0.125\n"},
      {"blanks", "  t_ms   a    b\n 10  1.5  -2\n 20 0.25  4e3\n 30  -7  0.125\n"},
      {"quotes", "\"t_ms\",\"a\",\"b\"\n\"10\",\"1.5\",\"-2\"\n20,0.25,\"4e3\"\n30,-7,0.125\n"},
      {"quoted decimal commas", "t_ms;a;b\n10;\"1,5\";-2\n20;\"0,25\";4e3\n30;-7;\"0,125\"\n"},
      {"sep=", "sep=;\nt_ms;a;b\n10;1,5;-2\n20;0,25;4e3\n30;-7;0,125\n"},
      {"comments", "# made by\n# hand, today\nt_ms,a,b\n10,1.5,-2\n# pause\n20,0.25,4e3\n30,-7,0.125\n"},
      {"header in a comment", "# t_ms a b\n10 1.5 -2\n20 0.25 4e3\n30 -7 0.125\n"},
      {"separator at the end", "t_ms,a,b,\n10,1.5,-2,\n20,0.25,4e3,\n30,-7,0.125,\n"},
      {"separator at the end of rows only", "t_ms,a,b\n10,1.5,-2,\n20,0.25,4e3,\n30,-7,0.125,\n"},
      {"plus signs, blank lines", "t_ms,a,b\n\n10,+1.5,-2\n20,0.25,4e3\n\n30,-7,+0.125\n\n"},
      {"a title", "Log of the robot\n\nt_ms,a,b\n10,1.5,-2\n20,0.25,4e3\n30,-7,0.125\n"}};
  for (const auto& [name, text] : texts) {
    SCOPED_TRACE(name);
    const LogTable table = read(text, request("", {"a", "b"}));
    EXPECT_THAT(table.time_ns, ElementsAre(10000000, 20000000, 30000000));
    EXPECT_THAT(table.values[0], ElementsAre(1.5, 0.25, -7));
    EXPECT_THAT(table.values[1], ElementsAre(-2, 4e3, 0.125));
  }
}

TEST(CsvLog, Headers) {
  EXPECT_THAT(names("time [ms],x [mm],yaw (deg)\n1,2,3\n2,3,4\n"),
              ElementsAre("time [ms]", "x [mm]", "yaw (deg)"));
  EXPECT_THAT(names("time,x\n[ms],[mm]\n10,2\n20,3\n"), ElementsAre("time [ms]", "x [mm]"));
  EXPECT_THAT(names("time,wheel,wheel\ns,left,right\n0.1,2,3\n0.2,3,4\n"),
              ElementsAre("time.s", "wheel.left", "wheel.right"));
  EXPECT_THAT(names("1,2,3\n2,3,4\n"), ElementsAre("#1", "#2", "#3"));
  EXPECT_THAT(names("t,x,x,\n1,2,3,4\n2,3,4,5\n"), ElementsAre("t", "x", "#3", "#4"));
  EXPECT_THAT(names("t;Gier [\xB0]\n1;2\n2;3\n"), ElementsAre("t", "Gier [\xC2\xB0]"));  // Latin-1
  EXPECT_THAT(names("state,mode\nidle,a\nbusy,b\n"), ElementsAre("state", "mode"));
  LogOptions options;
  options.header_rows = 2;
  EXPECT_EQ(sources("1,2\n3,4\n5,6\n", options)[0].rows, 1);
}

TEST(CsvLog, WithoutHeaderAndByNumber) {
  const std::string text = "1760000000.004 0.5 7\n1760000000.024 0.6 8\n1760000000.044 0.7 9\n";
  const LogTable table = read(text, request("", {"#3", "#2"}));
  EXPECT_THAT(table.time_ns, ElementsAre(1760000000004000000, 1760000000024000000, 1760000000044000000));
  EXPECT_THAT(table.values[0], ElementsAre(7, 8, 9));
  EXPECT_THAT(table.notes, ElementsAre("time: column '#1' taken as a time in s"));
  EXPECT_THAT(read("t_s,a\n1,5\n2,6\n", request("", {"#2"})).values[0], ElementsAre(5, 6));
}

TEST(CsvLog, TwoSensorsInOneTable) {
  const std::string text = "t_s;left;x\n0,1;;5\n0,2;1,5;\n0,3;;6\n0,4;NaN;n/a\n;7;8\n";
  const LogTable left = read(text, request("", {"left"})), both = read(text, request("", {"left", "x"}));
  EXPECT_THAT(left.time_ns, ElementsAre(200000000));
  EXPECT_THAT(left.values[0], ElementsAre(1.5));
  EXPECT_THAT(left.notes, ElementsAre("1 row without a time passed over",
                                      "3 rows without any of these values passed over"));
  EXPECT_THAT(both.time_ns, ElementsAre(100000000, 200000000, 300000000));
  EXPECT_TRUE(std::isnan(both.values[0][0]));
  EXPECT_EQ(both.values[1][0], 5);
}

TEST(CsvLog, SourcesAndText) {
  const LogSource source =
      sources("frame,time [ms],state,on\n0,10,idle,true\n1,20,busy,false\n2,50,busy,true\n")[0];
  EXPECT_EQ(source.rows, 3);
  EXPECT_EQ(source.first_ns, 10000000);
  EXPECT_EQ(source.last_ns, 50000000);
  EXPECT_EQ(source.largest_gap_ns, 30000000);
  EXPECT_EQ(source.fields[2].type, "text");
  EXPECT_EQ(source.fields[2].first, "idle");
  LogRequest wanted = request("", {"on"});
  wanted.text = {"state"};
  const LogTable table = read("frame,time [ms],state,on\n0,10,idle,true\n1,20,busy,false\n", wanted);
  EXPECT_THAT(table.text[0], ElementsAre("idle", "busy"));
  EXPECT_THAT(table.values[0], ElementsAre(1, 0));
  const LogTable dated =
      read("stamp,a\n2025-10-09 08:53:20.5,1\n2025-10-09 08:53:21,2\n", request("", {"a"}));
  EXPECT_THAT(dated.time_ns, ElementsAre(1760000000500000000, 1760000001000000000));
  const LogTable clock =
      read("when,a\n00:00:01.5,1\n00:00:02.25,2\n", request("", {"a"}, "when", "%H:%M:%S.%f"));
  EXPECT_THAT(clock.time_ns, ElementsAre(1500000000, 2250000000));
}

TEST(CsvLog, Refusals) {
  LogOptions point;
  point.separator = ";";
  point.decimal = ".";
  const TemporaryFolder folder;
  const auto said = [&](const std::string& text, const LogRequest& wanted, const LogOptions& options = {}) {
    return data_error([&] { read_log(folder.file("log.csv", text), wanted, options); });
  };
  EXPECT_TRUE(says(said("t_s;a;links\n1;2;12,5\n2;3;1,5\n", request("", {"links"}), point),
                   {"log.csv:2: field 3 'links': '12,5' is no number with decimal point: decimal comma? give "
                    "\"decimal\": \",\""}));
  EXPECT_TRUE(says(said("t_s,a\n1,2\n2,x1\n3,1\n4,1\n5,1\n", request("", {"a"})),
                   {"log.csv:3: field 2 'a': 'x1' is no number"}));
  EXPECT_TRUE(
      says(said("t_s,a\n1,2\n0.85,3\n", request("", {"a"})), {"log.csv:3: time goes back by 0.150 s"}));
  EXPECT_TRUE(says(said("t_s,a\n1,2\nx,3\n3,4\n4,5\n", request("", {"a"})),
                   {"log.csv:3: field 1 't_s': 'x' is no time in s"}));
  EXPECT_TRUE(says(said("t_s,a\n1,2\n2,3,4\n3,4\n", request("", {"a"})),
                   {"log.csv:3: found 3 fields, expected 2", "decimal commas"}));
  EXPECT_TRUE(says(said("t_s,a,b\n1,2,3\n2,3", request("", {"a"})), {"log.csv:3: ", "cut off"}));
  EXPECT_TRUE(says(said("t_s,a\n1,1e60\n2,3\n", request("", {"a"})), {"at most 1e+50"}));
  EXPECT_TRUE(says(said("t_s,a\n1,inf\n2,3\n", request("", {"a"})), {"log.csv:2: field 2"}));
  EXPECT_TRUE(says(said("\xFF\xFEt", request("", {"a"})), {"UTF-16"}));
  EXPECT_TRUE(says(said("\n\n", request("", {"a"})), {"found no line with a row"}));
  EXPECT_TRUE(says(said("t_s,a\n1,\"2\n2,3\n3,4\n", request("", {"a"})), {"log.csv:2: found a quote"}));
  EXPECT_TRUE(
      says(said("t_s,a\n1,\x1b[31m\n2,3\n3,4\n4,5\n", request("", {"a"})), {"'\\x1b[31m' is no number"}));
  EXPECT_TRUE(
      says(said("t_s,a\n" + std::string(2 << 20, 'x') + "\n", request("", {"a"})), {"longer than 1048576"}));
  std::string wide = "t_s";
  for (int k = 0; k < 10'001; ++k) wide += ",c";
  EXPECT_TRUE(says(said(wide + "\n", request("", {"a"})), {"found 10002 columns, expected at most 10000"}));
}

TEST(CsvLog, Questions) {
  const TemporaryFolder folder;
  const std::string file = folder.file("ticks.csv", "t_s,left,right\n1,2,3\n2,3,4\n");
  EXPECT_TRUE(says(usage_error([&] { read_log(file, request("", {"lefft"})); }),
                   {"no field 'lefft' in", "ticks.csv, did you mean 'left'? it has t_s, left, right"}));
  EXPECT_TRUE(
      says(usage_error([&] { read_log(file, request("wheels", {"left"})); }), {"no source 'wheels'"}));
  EXPECT_TRUE(
      says(usage_error([&] { read_log(file, request("", {"left"}, "time")); }), {"no column 'time'"}));
  EXPECT_TRUE(
      says(usage_error([&] { read_log(file, request("", {"left"}, "right")); }), {"'right'", "time_unit"}));
  const std::string timeless = folder.file("x.csv", "a,b\n1,5\n2,4\n");
  EXPECT_TRUE(
      says(usage_error([&] { read_log(timeless, request("", {"a"})); }), {"no column that tells time"}));
  EXPECT_THAT(read_log(timeless, request("", {"b"}, "a", "s")).time_ns, ElementsAre(1000000000, 2000000000));
  LogOptions bad;
  bad.decimal = ";";
  EXPECT_TRUE(says(usage_error([&] { open_log(file, bad); }), {"decimal"}));
  LogOptions encoding;
  encoding.encoding = "utf-8";
  const std::string latin = folder.file("l.csv", "t_s,\xB0\n1,2\n2,3\n");
  EXPECT_TRUE(says(data_error([&] { open_log(latin, encoding); }), {"no UTF-8", "latin-1"}));
  encoding.encoding = "ebcdic";
  EXPECT_TRUE(says(usage_error([&] { open_log(latin, encoding); }), {"encoding", "ebcdic"}));
}

TEST(CsvLog, CutFilesCanBeKept) {
  LogOptions keep;
  keep.keep_cut = true;
  const LogTable table = read("t_s,a,b\n1,2,3\n2,3,4\n3,4", request("", {"a"}), keep);
  EXPECT_THAT(table.values[0], ElementsAre(2, 3));
  EXPECT_THAT(table.notes, ElementsAre("line 4 is cut off and left out"));
}

TEST(CsvLog, SeveralRequestsInOneReading) {
  const TemporaryFolder folder;
  const std::string file = folder.file("two.csv", "t_s;l;x\n1;2;\n2;;3\n3;4;\n");
  const std::vector<LogTable> tables =
      open_log(file)->read({request("", {"l"}), request("", {"x", "x"})}, Stop());
  EXPECT_THAT(tables[0].values[0], ElementsAre(2, 4));
  EXPECT_THAT(tables[1].values[1], ElementsAre(3));
}

TEST(CsvLog, StopsWhenAsked) {
  const TemporaryFolder folder;
  const std::string file = folder.file("a.csv", "t_s,a\n1,2\n2,3\n");
  const std::unique_ptr<LogFile> log = open_log(file);
  const std::atomic<bool> now{true};
  EXPECT_THROW(log->sources(Stop(now)), Interruption);
  EXPECT_THROW(log->read({request("", {"a"})}, Stop(now)), Interruption);
}

TEST(CsvLog, OnlyRegularFiles) {
  EXPECT_TRUE(says(data_error([] { table_log_formats().back().open("/dev/zero", {}); }), {"/dev/zero"}));
}

TEST(CsvLog, DamagedCopies) {
  testing::expect_robust(
      kMark +
          "# a comment\r\nZeit [s];links [1/min];x [m];Gier [\xB0]\r\n0,001;;1,25;37,0\r\n0,004;-0,08;;\r\n"
          "0,010;\"1,5\";1,28;36,9\r\n0,020;;;\r\n0,023;0,12;;\r\n",
      "log.csv", 2000);
  EXPECT_LT(testing::peak_megabytes(), 300);
}

TEST(CsvLog, Samples) {
  ODOBENCH_NEEDS_LOGS();
  const auto folder = testing::log_samples();
  const LogTable ticks = read_log(folder / "ticks_ns.csv", request("", {"left_ticks", "right_ticks"}));
  EXPECT_EQ(ticks.time_ns.size(), 480u);
  EXPECT_EQ(ticks.time_ns.front(), 1760000000000234284);
  EXPECT_EQ(ticks.time_ns.back(), 1760000011975324092);
  EXPECT_EQ(sum_of(ticks.values[0]), 10367477);
  EXPECT_EQ(sum_of(ticks.values[1]), 12259609);
  const LogTable mocap = read_log(folder / "mocap_mm_deg.csv", request("", {"x [mm]", "y [mm]"}));
  EXPECT_EQ(mocap.time_ns.size(), 1200u);
  EXPECT_EQ(mocap.time_ns.front(), 137171000);
  EXPECT_NEAR(sum_of(mocap.values[0]), 2664199.22457505, 6);  // as rounded to 10 um in the file
  EXPECT_NEAR(sum_of(mocap.values[1]), 1117610.4194118107, 6);
  const LogTable wheels =
      read_log(folder / "merged_european.csv", request("", {"links [1/min]", "rechts [1/min]"}));
  EXPECT_EQ(wheels.time_ns.size(), 600u);
  const LogTable pose = read_log(folder / "merged_european.csv", request("", {"x [m]", "Gier [\xC2\xB0]"}));
  EXPECT_EQ(pose.time_ns.size(), 1200u);
  EXPECT_EQ(pose.time_ns.front(), 171000);
  EXPECT_NEAR(sum_of(pose.values[0]), 2664.19922457505, 6e-3);
  const LogTable angles = read_log(folder / "wheels.txt", request("", {"#2", "#3"}));
  EXPECT_EQ(angles.time_ns.size(), 600u);
  EXPECT_EQ(angles.time_ns.front(), 1760000000004026820);
  EXPECT_EQ(angles.time_ns.back(), 1760000011983828595);
}

}  // namespace
}  // namespace odobench
