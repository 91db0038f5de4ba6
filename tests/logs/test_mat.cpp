#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "datasets/logs/arrays/mat73_child.hpp"
#include "tests/support/binary_logs.hpp"
#include "tests/support/logs.hpp"

namespace odobench {
namespace {

using testing::bytes_of_numbers;
using testing::data_error;
using ::testing::ElementsAre;
using testing::mat_array;
using testing::mat_element;
using testing::mat_file;
using testing::mat_flags;
using testing::mat_small;
using testing::mat_struct;
using testing::open_log;
using testing::read_log;
using testing::request;
using testing::says;
using testing::sum_of;
using testing::TemporaryFolder;
using testing::usage_error;

constexpr std::uint32_t kDouble = 6, kInt64 = 14;
const std::vector<std::int64_t> kTimes{1760000000000234284, 1760000000024823389, 1760000000050013861};

std::vector<std::string> variables() {
  const std::string t = mat_array("", kInt64, {3, 1}, mat_element(12, bytes_of_numbers(kTimes)));
  // Numbers of class double, stored as int16 and uint8.
  const std::string count =
      mat_array("", kDouble, {3, 2}, mat_element(3, bytes_of_numbers<std::int16_t>({1, 3, 5, -2, 4, 6})));
  const std::string values = mat_array("", kDouble, {1, 3}, mat_small(2, std::string("\x07\x08\x09", 3)));
  const std::string seconds =
      mat_array("", kDouble, {3, 1}, mat_element(9, bytes_of_numbers<double>({0.25, 0.5, 0.75})));
  return {mat_struct("ticks", {{"t", t}, {"count", count}}),
          mat_struct("log", {{"time", seconds},
                             {"signals",
                              mat_struct("", {{"values", values},
                                              {"name", mat_array("", 4, {1, 1}, mat_element(16, "x"))}})}}),
          mat_array("rate", kDouble, {1, 1}, mat_element(9, bytes_of_numbers<double>({40}))),
          mat_array("on", 9 | 0x200, {3, 1}, mat_small(2, std::string("\x01\x00\x01", 3)))};
}

TEST(Mat, StructsAreSources) {
  const TemporaryFolder folder;
  for (const bool compressed : {false, true}) {
    const std::string file = folder.file("a.dat", mat_file(variables(), compressed));
    const std::vector<LogSource> sources = open_log(file)->sources(Stop());
    ASSERT_EQ(sources.size(), 4u);
    EXPECT_EQ(sources[0].name, "ticks");
    EXPECT_EQ(sources[0].type, "struct");
    EXPECT_EQ(sources[0].rows, 3);
    EXPECT_EQ(sources[0].first_ns, kTimes[0]);
    EXPECT_EQ(sources[0].last_ns, kTimes[2]);
    ASSERT_EQ(sources[0].fields.size(), 3u);
    EXPECT_EQ(sources[0].fields[0].type, "int64");
    EXPECT_EQ(sources[0].fields[2].path, "count[1]");
    EXPECT_EQ(sources[0].fields[2].first, "-2");
    EXPECT_EQ(sources[2].name, "");
    EXPECT_EQ(sources[2].fields[1].type, "bool");
    EXPECT_EQ(sources[3].name, "log.signals.name");
    EXPECT_EQ(sources[3].unreadable, "a text of MATLAB, expected numbers");
    const LogTable ticks = read_log(file, request("ticks", {"count[0]", "count[1]"}));
    EXPECT_EQ(ticks.time_ns, kTimes);
    EXPECT_THAT(ticks.values[0], ElementsAre(1, 3, 5));
    EXPECT_THAT(ticks.values[1], ElementsAre(-2, 4, 6));
    const LogTable log = read_log(file, request("log", {"signals.values"}));
    EXPECT_THAT(log.time_ns, ElementsAre(250000000, 500000000, 750000000));
    EXPECT_THAT(log.values[0], ElementsAre(7, 8, 9));
    EXPECT_TRUE(
        says(data_error([&] { read_log(file, request("log", {"signals.name"})); }), {"a text of MATLAB"}));
    EXPECT_TRUE(says(usage_error([&] { read_log(file, request("log", {"signals.valeus"})); }),
                     {"did you mean 'signals.values'?"}));
  }
}

TEST(Mat, StructArraysAndBigEndian) {
  const TemporaryFolder folder;
  const std::string v = mat_array("", kDouble, {1, 1}, mat_element(9, bytes_of_numbers<double>({2})));
  const std::vector<LogSource> sources =
      open_log(folder.file("s.mat", mat_file({mat_struct("s", {{"v", v}}, 2)})))->sources(Stop());
  ASSERT_EQ(sources.size(), 2u);
  EXPECT_EQ(sources[1].name, "s[1]");
  // 2x1 int16 {3, 258}, name "x", as a machine with the big end first writes it.
  std::string file(124, ' ');
  file += std::string("\x01\x00MI", 4);
  const std::string inner = std::string("\0\0\0\x06\0\0\0\x08\0\0\0\x0A\0\0\0\0", 16) +
                            std::string("\0\0\0\x05\0\0\0\x08\0\0\0\x02\0\0\0\x01", 16) +
                            std::string("\0\x01\0\x01x\0\0\0", 8) +
                            std::string("\0\x04\0\x03\0\x03\x01\x02", 8);
  file += std::string("\0\0\0\x0E\0\0\0", 7) + static_cast<char>(inner.size()) + inner;
  EXPECT_THAT(read_log(folder.file("b.mat", file), request("", {"x"}, "x", "ms")).values[0],
              ElementsAre(3, 258));
}

TEST(Mat, Refusals) {
  const TemporaryFolder folder;
  const auto said = [&](const std::string& bytes) {
    return data_error([&] { open_log(folder.file("a.mat", bytes))->sources(Stop()); });
  };
  const std::string table = mat_element(
      14, mat_flags(17) + mat_element(1, "T") + mat_element(1, "MCOS") + mat_element(1, "timetable") +
              mat_array("", kDouble, {1, 1}, mat_element(9, std::string(8, '\0'))));
  EXPECT_TRUE(says(said(mat_file({table})),
                   {"a.mat: T: a timetable of MATLAB",
                    "s = table2struct(T,'ToScalar',true); save('log.mat','-struct','s','-v7')"}));
  EXPECT_TRUE(says(said(mat_file({})), {"found no array"}));
  EXPECT_TRUE(says(said(mat_file({mat_array("c", 1, {1, 1}, "")})), {"c: a cell array"}));
  EXPECT_TRUE(says(said(mat_file({mat_array("x", kDouble, {2, 1}, mat_element(9, std::string(8, '\0')))})),
                   {"x: found 8 bytes of numbers, expected 16"}));
  EXPECT_TRUE(says(said(mat_file({mat_array("x", kDouble, {0x7FFFFFFF, 0x7FFFFFFF}, mat_element(9, ""))})),
                   {"x: its dimensions are too large"}));
  EXPECT_TRUE(says(said(mat_file(variables()).substr(0, 500)), {"bytes expected", "the file is cut off"}));
  std::string nested = mat_array("", kDouble, {1, 1}, mat_element(9, std::string(8, '\0')));
  for (int k = 0; k < 20; ++k) nested = mat_struct("", {{"a", nested}});
  EXPECT_TRUE(says(said(mat_file({mat_struct("s", {{"a", nested}})})), {"nested deeper than 16"}));
}

TEST(Mat, Bombs) {
  const TemporaryFolder folder;
  const std::string zeros =
      mat_array("t", 9, {120'000'000, 1}, mat_element(2, std::string(120'000'000, '\0')));
  const std::string file = folder.file("bomb.mat", mat_file({zeros}, true));
  const long before = testing::peak_megabytes();
  EXPECT_EQ(open_log(file)->sources(Stop())[0].rows, 120'000'000);
  EXPECT_TRUE(says(data_error([&] { read_log(file, request("", {"t"}, "t", "s")); }),
                   {"more than 100,000,000 values"}));
  EXPECT_LT(testing::peak_megabytes() - before, 100);
}

TEST(Mat, DamagedCopies) {
  testing::expect_robust(mat_file(variables()), "a.mat", 2000);
  testing::expect_robust(mat_file(variables(), true), "a.mat", 2000);
}

TEST(Mat, Version73) {
  const TemporaryFolder folder;
  std::string header = "MATLAB 7.3 MAT-file, cut off";
  header.resize(124, ' ');
  header += std::string("\x00\x02IM", 4) + std::string(384, '\0') + "\x89HDF\r\n\x1a\n";
  const std::string file = folder.file("a.mat", header);
  const std::string said = data_error([&] { open_log(file)->sources(Stop()); });
  if (!has_matio()) {
    EXPECT_TRUE(says(said, {"version 7.3", "libmatio-dev", "'-v7'"}));
    return;
  }
  EXPECT_TRUE(says(said, {"a.mat: "}));
  ODOBENCH_NEEDS_LOGS();
  const std::string whole = read_file(testing::log_samples() / "courier_v73.mat");
  int read = 0;
  for (std::size_t k = 0; k < 24; ++k) {
    std::string damaged = whole.substr(0, k % 2 == 0 ? whole.size() : whole.size() * k / 24);
    for (std::size_t i = 0; i < 8; ++i)
      damaged[512 + (k * 7919 + i * 104729) % (damaged.size() - 512)] ^= static_cast<char>(0x55);
    const std::string copy = folder.file("b.mat", damaged);
    const std::string refusal = data_error([&] { testing::read_everything(copy); });
    read += refusal.empty() ? 1 : 0;
    EXPECT_EQ(refusal.find('\n'), std::string::npos);
  }
  EXPECT_LT(read, 24);
}

TEST(Mat, Samples) {
  ODOBENCH_NEEDS_LOGS();
  for (const char* name : {"courier_v5.mat", "courier_v7.mat", "courier_v73.mat"}) {
    if (!has_matio() && std::string(name) == "courier_v73.mat") continue;
    const auto file = testing::log_samples() / name;
    const LogTable ticks = read_log(file, request("ticks", {"count[0]", "count[1]"}));
    EXPECT_EQ(ticks.time_ns.size(), 480u);
    EXPECT_EQ(ticks.time_ns.front(), 1760000000000234284);
    EXPECT_EQ(ticks.time_ns.back(), 1760000011975324092);
    EXPECT_EQ(sum_of(ticks.values[0]), 10367477);
    EXPECT_EQ(sum_of(ticks.values[1]), 12259609);
    EXPECT_NEAR(sum_of(read_log(file, request("imu", {"gyro_z"})).values[0]), 72.45727791018297, 72e-9);
    const LogTable mocap = read_log(file, request("mocap", {"pose[0]", "pose[1]"}));
    EXPECT_EQ(mocap.time_ns.back(), 1760000012127046980);
    EXPECT_NEAR(sum_of(mocap.values[0]), 2664.19922457505, 2664e-9);
    EXPECT_NEAR(sum_of(mocap.values[1]), 1117.6104194118107, 1117e-9);
    const LogTable joints =
        read_log(file, request("joints", {"position[0]", "position[1]", "velocity[0]", "velocity[1]"}));
    EXPECT_EQ(joints.time_ns.size(), 600u);
    EXPECT_NEAR(sum_of(joints.values[2]) + sum_of(joints.values[3]), 6799.92718129763, 6800e-9);
  }
}

}  // namespace
}  // namespace odobench
