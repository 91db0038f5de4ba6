#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/binary_logs.hpp"
#include "tests/support/logs.hpp"

namespace odobench {
namespace {

using testing::bytes_of_numbers;
using testing::data_error;
using ::testing::ElementsAre;
using testing::npy_file;
using testing::open_log;
using testing::read_log;
using testing::request;
using testing::says;
using testing::sum_of;
using testing::TemporaryFolder;
using testing::usage_error;
using testing::zip_file;
using testing::ZipOptions;

const std::vector<std::int64_t> kTimes{1760000000000234284, 1760000000024823389, 1760000000050013861};

std::string time_array() {
  return npy_file("<i8", "(3,)", bytes_of_numbers(kTimes));
}

std::vector<std::pair<std::string, std::string>> members() {
  return {{"ticks_t.npy", time_array()},
          {"ticks_count.npy", npy_file("<i4", "(3, 2)", bytes_of_numbers<std::int32_t>({1, 2, 3, 4, 5, 6}))},
          {"imu_time_us.npy", npy_file("<u4", "(3,)", bytes_of_numbers<std::uint32_t>({10, 20, 30}))},
          {"imu_gyro_z.npy", npy_file("<f4", "(3,)", bytes_of_numbers<float>({0.5f, 0.25f, -1}))},
          {"rate.npy", npy_file("<f8", "()", bytes_of_numbers<double>({40}))}};
}

TEST(Npz, PrefixesAreSources) {
  const TemporaryFolder folder;
  for (const ZipOptions& options :
       {ZipOptions{}, ZipOptions{true, false, 0}, ZipOptions{false, true, 0}, ZipOptions{true, true, 0}}) {
    const std::string file = folder.file("a.dat", zip_file(members(), options));
    const std::vector<LogSource> sources = open_log(file)->sources(Stop());
    ASSERT_EQ(sources.size(), 3u);
    EXPECT_EQ(sources[0].name, "ticks");
    EXPECT_EQ(sources[0].rows, 3);
    EXPECT_EQ(sources[0].first_ns, kTimes[0]);
    EXPECT_EQ(sources[0].last_ns, kTimes[2]);
    EXPECT_EQ(sources[0].largest_gap_ns, 25190472);
    ASSERT_EQ(sources[0].fields.size(), 3u);
    EXPECT_EQ(sources[0].fields[2].path, "count[1]");
    EXPECT_EQ(sources[0].fields[2].type, "int32");
    EXPECT_EQ(sources[0].fields[2].first, "2");
    EXPECT_EQ(sources[1].name, "imu");
    EXPECT_EQ(sources[2].name, "");
    const LogTable ticks = read_log(file, request("ticks", {"count[1]", "count[0]"}));
    EXPECT_EQ(ticks.time_ns, kTimes);
    EXPECT_THAT(ticks.values[0], ElementsAre(2, 4, 6));
    EXPECT_THAT(ticks.values[1], ElementsAre(1, 3, 5));
    const LogTable imu = read_log(file, request("imu", {"gyro_z"}));
    EXPECT_THAT(imu.time_ns, ElementsAre(10000, 20000, 30000));
    EXPECT_THAT(imu.values[0], ElementsAre(0.5, 0.25, -1));
  }
}

TEST(Npz, OneArray) {
  const TemporaryFolder folder;
  const std::vector<double> by_rows{0, 1, 2, 0.01, 3, 4, 0.02, 5, 6},
      by_columns{0, 0.01, 0.02, 1, 3, 5, 2, 4, 6};
  for (const bool fortran : {false, true}) {
    const std::string file =
        folder.file("a.npy", npy_file("<f8", "(3, 3)", bytes_of_numbers(fortran ? by_columns : by_rows),
                                      fortran, fortran ? 2 : 1));
    EXPECT_EQ(open_log(file)->sources(Stop())[0].fields[2].path, "#3");
    EXPECT_TRUE(says(usage_error([&] { read_log(file, request("", {"#3"})); }), {"no vector"}));
  }
  const std::string vector =
      folder.file("v.npy", npy_file(">i2", "(3,)", std::string("\0\x0A\0\x14\0\x1E", 6)));
  EXPECT_THAT(read_log(vector, request("", {"#1"}, "#1", "ms")).time_ns,
              ElementsAre(10000000, 20000000, 30000000));
}

TEST(Npz, Types) {
  const TemporaryFolder folder;
  const std::string t = npy_file("<f8", "(3,)", bytes_of_numbers<double>({0.1, 0.2, 0.3}));
  const std::vector<std::tuple<std::string, std::string, double>> arrays{
      {"|i1", std::string("\xFF\x01\x02", 3), 2},
      {"|u1", std::string("\xFF\x01\x02", 3), 258},
      {"|b1", std::string("\x01\x00\x01", 3), 2},
      {"<i2", bytes_of_numbers<std::int16_t>({-3, 4, 5}), 6},
      {"<u2", bytes_of_numbers<std::uint16_t>({65535, 4, 5}), 65544},
      {"<u8", bytes_of_numbers<std::uint64_t>({1, 2, 3}), 6},
      {"<f4", bytes_of_numbers<float>({1.5f, 2, 3}), 6.5}};
  for (const auto& [descr, data, sum] : arrays) {
    const std::string file =
        folder.file("a.npz", zip_file({{"t.npy", t}, {"v.npy", npy_file(descr, "(3,)", data)}}));
    EXPECT_EQ(sum_of(read_log(file, request("", {"v"})).values[0]), sum) << descr;
  }
}

TEST(Npz, Refusals) {
  const TemporaryFolder folder;
  const auto said = [&](const std::string& bytes) {
    return data_error([&] { open_log(folder.file("a.npz", bytes))->sources(Stop()); });
  };
  EXPECT_TRUE(says(said(zip_file({{"o.npy", npy_file("|O", "(3,)", "xyz")}})),
                   {"a.npz: o: object array: save numbers"}));
  EXPECT_TRUE(
      says(said(zip_file({{"o.npy", npy_file("[('a', '<f8')]", "(3,)", "xyz")}})), {"array of records"}));
  EXPECT_TRUE(says(said(zip_file({{"o.npy", npy_file("<U3", "(3,)", "xyz")}})), {"type <U3"}));
  EXPECT_TRUE(
      says(said(zip_file({{"o.npy", npy_file("<f8", "(3,)", "xyz")}})), {"o.npy: 21 bytes are missing"}));
  EXPECT_TRUE(
      says(said(zip_file({{"o.npy", npy_file("<i1", "(2,)", "xyz")}})), {"more bytes than its shape"}));
  EXPECT_TRUE(says(said(zip_file({{"o.npy", npy_file("<f8", "(99999999999, 99999999999)", "x")}})),
                   {"a shape that is none or too large"}));
  EXPECT_TRUE(says(said(zip_file({{"o.npy", npy_file("<f8", "(100000000,)", "x")}})),
                   {"claims 800000000 bytes, more than 536870912"}));
  EXPECT_TRUE(says(said(zip_file({{"o.npy", npy_file("<f8", "(3, 20000)", "x")}})), {"too large"}));
  EXPECT_TRUE(
      says(said(zip_file(members(), {false, true, std::uint64_t{1} << 40})), {"claims 1099511627776 bytes"}));
  std::string damaged = zip_file(members());
  damaged[damaged.find("(3,)") + 60] ^= 1;  // in the header's padding or the numbers behind it
  EXPECT_TRUE(says(said(damaged), {"ticks_t.npy", "check sum"}));
  // Mixed with arrays that can be read, an object is named and the rest stays.
  auto mixed = members();
  mixed.emplace_back("names.npy", npy_file("|O", "(3,)", "xyz"));
  const std::string file = folder.file("m.npz", zip_file(mixed));
  EXPECT_EQ(open_log(file)->sources(Stop()).back().unreadable, "object array: save numbers");
  EXPECT_EQ(read_log(file, request("ticks", {"count[0]"})).time_ns, kTimes);
  EXPECT_TRUE(says(data_error([&] { read_log(file, request("names", {"x"})); }), {"names: object array"}));
  EXPECT_TRUE(says(usage_error([&] { read_log(file, request("ticks", {"cont[0]"})); }),
                   {"did you mean 'count[0]'?"}));
  EXPECT_TRUE(says(usage_error([&] { read_log(file, request("tick", {"t"})); }),
                   {"no source 'tick'", "did you mean 'ticks'?"}));
  const std::string uneven =
      folder.file("u.npz", zip_file({{"t.npy", time_array()}, {"v.npy", npy_file("|u1", "(2,)", "xy")}}));
  EXPECT_TRUE(
      says(data_error([&] { read_log(uneven, request("", {"v"})); }), {"v has 2 rows, expected 3 as in t"}));
  const std::string back = folder.file(
      "b.npz", zip_file({{"t.npy", npy_file("<f8", "(3,)", bytes_of_numbers<double>({1, 2, 1.85}))}}));
  EXPECT_TRUE(says(data_error([&] { read_log(back, request("", {"t"}, "t", "s")); }),
                   {"t: row 3: time goes back by 0.150 s"}));
}

// 120 MB of zeros in 120 kB: looked at without being kept; kept values are counted before.
TEST(Npz, Bombs) {
  const TemporaryFolder folder;
  const std::string zeros = npy_file("|u1", "(120000000,)", std::string(120'000'000, '\0'));
  const std::string file = folder.file("bomb.npz", zip_file({{"t.npy", zeros}}, {true, false, 0}));
  const long before = testing::peak_megabytes();
  EXPECT_EQ(open_log(file)->sources(Stop())[0].rows, 120'000'000);
  EXPECT_TRUE(says(data_error([&] { read_log(file, request("", {"t"}, "t", "s")); }),
                   {"more than 100,000,000 values"}));
  EXPECT_LT(testing::peak_megabytes() - before, 100);
}

TEST(Npz, DecompressedBytesAreLimited) {
  const TemporaryFolder folder;
  LogOptions options;
  options.max_bytes = 500;
  const std::string file = folder.file("a.npz", zip_file(members(), {true, false, 0}));
  EXPECT_TRUE(says(data_error([&] { open_log(file, options)->sources(Stop()); }), {"--max-bytes"}));
}

TEST(Npz, DamagedCopies) {
  testing::expect_robust(zip_file(members()), "a.npz", 2000);
  testing::expect_robust(zip_file(members(), {true, true, 0}), "a.npz", 2000);
  testing::expect_robust(time_array(), "a.npy", 2000);
}

TEST(Npz, Samples) {
  ODOBENCH_NEEDS_LOGS();
  for (const char* name : {"courier.npz", "courier_deflated.npz"}) {
    const auto file = testing::log_samples() / name;
    const LogTable ticks = read_log(file, request("ticks", {"count[0]", "count[1]"}));
    EXPECT_EQ(ticks.time_ns.size(), 480u);
    EXPECT_EQ(ticks.time_ns.front(), 1760000000000234284);
    EXPECT_EQ(ticks.time_ns.back(), 1760000011975324092);
    EXPECT_EQ(sum_of(ticks.values[0]), 10367477);
    EXPECT_EQ(sum_of(ticks.values[1]), 12259609);
    const LogTable imu = read_log(file, request("imu", {"gyro_z"}));
    EXPECT_NEAR(sum_of(imu.values[0]), 72.45727791018297, 72e-9);
    const LogTable mocap = read_log(file, request("mocap", {"pose[0]", "pose[1]"}));
    EXPECT_EQ(mocap.time_ns.size(), 1200u);
    EXPECT_NEAR(sum_of(mocap.values[0]), 2664.19922457505, 2664e-9);
    EXPECT_NEAR(sum_of(mocap.values[1]), 1117.6104194118107, 1117e-9);
    const LogTable joints =
        read_log(file, request("joints", {"position[0]", "position[1]", "velocity[0]", "velocity[1]"}));
    EXPECT_EQ(joints.time_ns.size(), 600u);
    EXPECT_EQ(joints.time_ns.front(), 1760000000004026820);
  }
}

}  // namespace
}  // namespace odobench
