#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/logs.hpp"

namespace odobench {
namespace {

using testing::data_error;
using ::testing::ElementsAre;
using testing::open_log;
using testing::read_log;
using testing::request;
using testing::says;
using testing::sum_of;
using testing::TemporaryFolder;
using testing::usage_error;

const std::string kMixed =
    "{\"topic\":\"wheels\",\"t\":1760000000000234,\"data\":[1,2],\"ok\":true}\n"
    "{\"topic\":\"pose\",\"t\":1760000000137171,\"position\":{\"x\":1.5,\"y\":-0.25},\"frame\":\"map\"}\n"
    "\n"
    "{\"topic\":\"wheels\",\"t\":1760000000024823,\"data\":[3,4],\"ok\":false}\n"
    "{\"topic\":\"pose\",\"t\":1760000000147015,\"position\":{\"y\":-0.5,\"x\":null},\"frame\":\"map\"}\n"
    "{\"topic\":\"wheels\",\"t\":1760000000050000,\"data\":[5,6],\"ok\":true}\n"
    "{\"topic\":\"pose\",\"t\":1760000000157015,\"position\":{\"x\":2,\"y\":-1},\"frame\":\"odom\"}\n";

TEST(JsonLines, TopicsAreSources) {
  const TemporaryFolder folder;
  const std::string file = folder.file("drive.log", kMixed);
  const std::vector<LogSource> sources = open_log(file)->sources(Stop());
  ASSERT_EQ(sources.size(), 2u);
  EXPECT_EQ(sources[0].name, "wheels");
  EXPECT_EQ(sources[0].rows, 3);
  EXPECT_EQ(sources[0].first_ns, 1760000000000234000);
  EXPECT_EQ(sources[0].last_ns, 1760000000050000000);
  EXPECT_EQ(sources[0].largest_gap_ns, 25177000);
  ASSERT_EQ(sources[0].fields.size(), 4u);
  EXPECT_EQ(sources[0].fields[1].path, "data[0]");
  EXPECT_EQ(sources[0].fields[1].first, "1");
  EXPECT_EQ(sources[0].fields[3].type, "bool");
  EXPECT_EQ(sources[1].fields[1].path, "position.x");
  const LogTable wheels = read_log(file, request("wheels", {"data[1]", "ok"}));
  EXPECT_THAT(wheels.values[0], ElementsAre(2, 4, 6));
  EXPECT_THAT(wheels.values[1], ElementsAre(1, 0, 1));
  LogRequest wanted = request("pose", {"position.x", "position.y"}, "t", "us");
  wanted.text = {"frame"};
  const LogTable pose = read_log(file, wanted);
  EXPECT_THAT(pose.time_ns, ElementsAre(1760000000137171000, 1760000000147015000, 1760000000157015000));
  EXPECT_TRUE(std::isnan(pose.values[0][1]));
  EXPECT_THAT(pose.values[1], ElementsAre(-0.25, -0.5, -1));
  EXPECT_THAT(pose.text[0], ElementsAre("map", "map", "odom"));
}

TEST(JsonLines, WithoutTopicsAndDecimalSeconds) {
  const TemporaryFolder folder;
  const std::string file = folder.file(
      "a.jsonl",
      "{\"time\":1760000000.123456789,\"a\":{\"b\":[{\"c\":1}]}}\n{\"time\":1760000000.223456789,\"a\":{}}\n"
      "{\"time\":1760000000.323456789,\"a\":{\"b\":[{\"c\":3}]}}");
  const LogTable table = read_log(file, request("", {"a.b[0].c"}));
  EXPECT_THAT(table.time_ns, ElementsAre(1760000000123456789, 1760000000323456789));
  EXPECT_THAT(table.values[0], ElementsAre(1, 3));
  EXPECT_THAT(table.notes, ElementsAre("time: field 'time' taken as a time in s",
                                       "1 line without any of these values passed over"));
}

TEST(JsonLines, Refusals) {
  const TemporaryFolder folder;
  const auto said = [&](const std::string& text, const LogRequest& wanted) {
    return data_error([&] { read_log(folder.file("a.jsonl", text), wanted); });
  };
  const LogRequest a = request("", {"a"}, "t", "s");
  EXPECT_TRUE(says(said("{\"t\":1,\"a\":2}\n{\"t\":2,\"a\"}\n", a), {"a.jsonl:2: broken JSON"}));
  EXPECT_TRUE(says(said("{\"t\":1,\"a\":2}\n{\"t\":2,\"a", a), {"a.jsonl:2: ", "cut off"}));
  EXPECT_TRUE(
      says(said("{\"t\":1,\"a\":2}\n{\"t\":0.85,\"a\":2}\n", a), {"a.jsonl:2: time goes back by 0.150 s"}));
  EXPECT_TRUE(says(said("{\"t\":1,\"a\":\"x\"}\n", a), {"a.jsonl:1: field 'a' is no number"}));
  EXPECT_TRUE(says(said("{\"t\":\"x\",\"a\":1}\n", a), {"a.jsonl:1: field 't' is no time in s"}));
  EXPECT_TRUE(says(said("{\"t\":1,\"a\":NaN}\n", a), {"a.jsonl:1", "NaN"}));
  const std::string deep = "{\"t\":1,\"a\":" + std::string(40, '[') + std::string(40, ']') + "}\n";
  EXPECT_TRUE(says(said(deep, a), {"a.jsonl:1: found a value nested deeper than 32"}));
  const std::string far = folder.file("b.jsonl", kMixed);
  EXPECT_TRUE(says(usage_error([&] { read_log(far, request("poses", {"yaw"})); }),
                   {"no source 'poses'", "did you mean 'pose'?"}));
  EXPECT_TRUE(says(usage_error([&] { read_log(far, request("pose", {"position.z"})); }),
                   {"no field 'position.z' in pose, did you mean 'position.x'? it has t, position.x"}));
  LogOptions keep;
  keep.keep_cut = true;
  const std::string cut = folder.file("c.jsonl", "{\"t\":1,\"a\":2}\n{\"t\":2,\"a");
  EXPECT_THAT(read_log(cut, a, keep).notes, ElementsAre("line 2 is cut off and left out"));
}

TEST(JsonLines, Limits) {
  const TemporaryFolder folder;
  std::string wide = "{\"t\":1", array = "{\"t\":1,\"a\":[0";
  for (int k = 0; k < 11'000; ++k) wide += ",\"k" + std::to_string(k) + "\":1";
  for (int k = 0; k < 100'000; ++k) array += ",0";
  EXPECT_TRUE(says(data_error([&] { open_log(folder.file("w.jsonl", wide + "}\n"))->sources(Stop()); }),
                   {"more than 10000 fields"}));
  EXPECT_EQ(open_log(folder.file("a.jsonl", array + "]}\n"))->sources(Stop())[0].fields.size(), 17u);
  EXPECT_THAT(read_log(folder.path() / "a.jsonl", request("", {"a[99999]"}, "t", "s")).values[0],
              ElementsAre(0));
}

TEST(JsonLines, DamagedCopies) {
  testing::expect_robust(kMixed, "drive.jsonl", 2000);
  EXPECT_LT(testing::peak_megabytes(), 300);
}

TEST(JsonLines, Sample) {
  ODOBENCH_NEEDS_LOGS();
  const auto file = testing::log_samples() / "drive.jsonl";
  const LogTable wheels = read_log(file, request("encoders", {"data[0]", "data[1]"}));
  EXPECT_EQ(wheels.time_ns.size(), 480u);
  EXPECT_EQ(wheels.time_ns.front(), 1760000000000234000);
  EXPECT_EQ(wheels.time_ns.back(), 1760000011975324000);
  EXPECT_EQ(sum_of(wheels.values[0]), 10367477);
  EXPECT_EQ(sum_of(wheels.values[1]), 12259609);
  const LogTable pose = read_log(file, request("pose", {"position.x", "position.y", "yaw"}));
  EXPECT_EQ(pose.time_ns.size(), 1200u);
  EXPECT_NEAR(sum_of(pose.values[0]), 2664.19922457505, 6e-4);  // rounded to 1 um in the file
}

}  // namespace
}  // namespace odobench
