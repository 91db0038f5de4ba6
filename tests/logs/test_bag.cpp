#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "datasets/logs/ros/ros_logs.hpp"
#include "tests/support/data_error.hpp"
#include "tests/support/run_process.hpp"
#include "tests/support/small_log.hpp"

namespace odobench {
namespace {

using testing::bag_bytes;
using testing::data_error;
using testing::expect_small_log;
using testing::says;
using testing::small_log;
using testing::TemporaryFolder;

const testing::WrittenLog& log_of_ros1() {
  static const testing::WrittenLog log = small_log(RosEncoding::Ros1);
  return log;
}

class Bag : public ::testing::Test {
 protected:
  std::unique_ptr<LogFile> open(const std::string& bytes, const LogOptions& options = {}) const {
    return open_ros_recording({folder_.file("drive.bag", bytes)}, options);
  }
  std::string refusal(const std::string& bytes, const LogOptions& options = {}) const {
    return data_error([&] { open(bytes, options)->read(testing::small_log_requests(), {}); });
  }
  TemporaryFolder folder_;
};

TEST_F(Bag, IsReadWithAnyCompression) {
  for (const char* compression : {"none", "bz2", "lz4"})
    for (const std::size_t per_chunk : {1, 7, 1000}) {
      SCOPED_TRACE(fmt::format("{} {}", compression, per_chunk));
      expect_small_log(*open(bag_bytes(log_of_ros1(), compression, per_chunk)));
    }
}

TEST_F(Bag, OfACrashedRecorderIsReadWithoutChunksAndIndex) {
  expect_small_log(*open(bag_bytes(log_of_ros1(), "none", 0)));
}

TEST_F(Bag, IsRecognisedByItsBytes) {
  const std::string bytes = bag_bytes(log_of_ros1(), "none");
  const std::string file = folder_.file("some.txt", bytes);
  int formats = 0;
  for (const LogFormat& format : ros_log_formats())
    formats += format.recognises(file, bytes.substr(0, 4096)) ? 1 : 0;
  EXPECT_EQ(formats, 1);
  EXPECT_EQ(open(bytes)->format(), "ROS 1 bag");
}

TEST_F(Bag, ListsWhatStandsInIt) {
  const std::vector<LogSource> sources = open(bag_bytes(log_of_ros1(), "lz4"))->sources({});
  ASSERT_EQ(sources.size(), 3u);
  EXPECT_EQ(sources[1].type, "sensor_msgs/JointState");
  EXPECT_EQ(sources[1].rows, testing::kSmallLogMessages);
  EXPECT_EQ(sources[1].largest_gap_ns, testing::kSmallLogStep);
  EXPECT_EQ(sources[1].first_ns, testing::kSmallLogBegin + testing::kSmallLogDelay);
  EXPECT_EQ(sources[1].stamp_minus_log_ns, -testing::kSmallLogDelay);
  EXPECT_EQ(sources[2].stamp_minus_log_ns, -testing::kSmallLogDelay);
  std::vector<std::string> paths;
  for (const LogField& f : sources[1].fields) paths.push_back(f.path);
  EXPECT_THAT(paths,
              ::testing::IsSupersetOf({"header.seq", "header.stamp", "position[name=left]",
                                       "position[name=right]", "velocity[name=left]", "position[name=arm]"}));
  EXPECT_THAT(paths, ::testing::Not(::testing::Contains("velocity[name=arm]")));
}

TEST_F(Bag, ThatIsCutOffIsRefusedOrKept) {
  const std::string whole = bag_bytes(log_of_ros1(), "none", 9);
  const std::string cut = whole.substr(0, whole.size() / 2);
  EXPECT_TRUE(
      says(refusal(cut), {"drive.bag: byte ", " bytes expected, ",
                          " left: the bag is cut off (--keep-cut imports the ", " messages before)"}));
  LogOptions options;
  options.keep_cut = true;
  const auto tables = open(cut, options)->read(testing::small_log_requests(), {});
  const auto rows = static_cast<int>(tables[0].time_ns.size());
  EXPECT_GT(rows, 5);
  EXPECT_LT(rows, testing::kSmallLogMessages);
  EXPECT_EQ(tables[0].values[0].back(), rows - 1);
  ASSERT_FALSE(tables[0].notes.empty());
  EXPECT_THAT(tables[0].notes.back(), ::testing::HasSubstr("cut off"));
}

TEST_F(Bag, WithWrongClaimsIsRefused) {
  const std::string magic = "#ROSBAG V2.0\n";
  const auto chunk = [&](const std::string& compression, std::uint32_t size, const std::string& data) {
    return magic +
           testing::bag_record(
               {{"op", "\x05"}, {"compression", compression}, {"size", testing::number_bytes(size)}}, data);
  };
  EXPECT_TRUE(says(refusal(chunk("lz4", 943718400, "x")),
                   {"drive.bag: chunk at byte 13 claims 943718400 bytes, more than 67108864"}));
  EXPECT_TRUE(
      says(refusal(chunk("none", 5, "x")), {"drive.bag: byte 13: a chunk that claims 5 bytes and has 1"}));
  EXPECT_TRUE(says(refusal(chunk("lz4", 5, "x")), {"byte 13: chunk: "}));
  EXPECT_TRUE(
      says(refusal(chunk("lz4", 5, testing::compressed("lz4", "abc"))), {"claims 5 bytes and gives 3"}));
  EXPECT_TRUE(says(refusal(chunk("lz4", 2, testing::compressed("lz4", "abc"))),
                   {"decompresses to more than 2 bytes"}));
  EXPECT_TRUE(
      says(refusal(chunk("x\x1b[31m", 5, "x")), {"compressed by 'x\\x1b[31m', expected none, bz2 or lz4"}));
  EXPECT_TRUE(says(refusal(magic + testing::bag_record({{"op", "\x03"}, {"encryptor", "rosbag/Aes"}}, "")),
                   {"encrypted"}));
  EXPECT_TRUE(says(refusal(magic + testing::bag_record({{"xx", "\x03"}}, "")), {"without the field 'op'"}));
  EXPECT_TRUE(
      says(refusal(magic + testing::bag_record({{"op", "\x02"}, {"conn", testing::number_bytes(7)}}, "")),
           {"connection 7, which has no record"}));
  EXPECT_TRUE(says(refusal("#ROSBAG V1.2\n"), {"byte 0", "rosbag fix"}));
  EXPECT_TRUE(says(refusal("something else"), {"byte 0", "expected a ROS 1 bag"}));
  EXPECT_TRUE(says(refusal(""), {"byte 0"}));
}

TEST_F(Bag, DecompressesNoMoreThanIsAllowed) {
  LogOptions options;
  options.max_bytes = 1000;
  EXPECT_TRUE(says(refusal(bag_bytes(log_of_ros1(), "bz2"), options),
                   {"decompresses to more than 1000 bytes (--max-bytes)"}));
}

TEST_F(Bag, ThatIsNoRegularFileIsRefused) {
  EXPECT_TRUE(says(data_error([&] { open_ros_recording({"/dev/null"}, {}); }),
                   {"a device", "expected a regular file"}));
  EXPECT_TRUE(says(data_error([&] { open_ros_recording({folder_.path()}, {}); }), {"found no .db3"}));
}

TEST_F(Bag, TimeIsThatOfTheLogWhereAStampIsMissing) {
  testing::WrittenLog log;
  log.channels = {{"/count", "std_msgs/Int64", "int64 data"},
                  {"/zero", "a/B",
                   "Header header\nint32 x\n" + std::string(80, '=') +
                       "\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n"}};
  for (int k = 0; k < 4; ++k) {
    log.messages.push_back(
        {0, 1000 + k, testing::MessageBytes(RosEncoding::Ros1).number(std::int64_t{k}).bytes()});
    log.messages.push_back(
        {1, 2000 + k, testing::MessageBytes(RosEncoding::Ros1).header(k < 2 ? 0 : 77, "").number(k).bytes()});
  }
  const auto tables =
      open(bag_bytes(log, "none"))
          ->read({testing::log_request("/count", {"data"}), testing::log_request("/zero", {"x"})}, {});
  EXPECT_THAT(tables[0].time_ns, ::testing::ElementsAre(1000, 1001, 1002, 1003));
  EXPECT_THAT(tables[0].notes,
              ::testing::ElementsAre("topic /count: 4 of 4 rows have no stamp: their time is the log's"));
  EXPECT_THAT(tables[1].time_ns, ::testing::ElementsAre(2000, 2001, 77, 77));
  EXPECT_THAT(tables[1].notes,
              ::testing::ElementsAre("topic /zero: 2 of 4 rows have stamp 0: their time is the log's"));
  LogRequest own = testing::log_request("/count", {"data"});
  own.time = "data";
  own.time_unit = "ms";
  EXPECT_THAT(open(bag_bytes(log, "none"))->read({own}, {})[0].time_ns,
              ::testing::ElementsAre(0, 1'000'000, 2'000'000, 3'000'000));
}

TEST_F(Bag, StopsWhenAsked) {
  const std::atomic<bool> stop{true};
  EXPECT_THROW(open(bag_bytes(log_of_ros1(), "none"))->read(testing::small_log_requests(), Stop(stop)),
               Interruption);
}

}  // namespace
}  // namespace odobench
