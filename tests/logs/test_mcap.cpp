#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "datasets/logs/ros/ros_logs.hpp"
#include "tests/support/data_error.hpp"
#include "tests/support/run_process.hpp"
#include "tests/support/small_log.hpp"

namespace odobench {
namespace {

using testing::data_error;
using testing::expect_small_log;
using testing::mcap_bytes;
using testing::McapOptions;
using testing::says;
using testing::small_log;

const testing::WrittenLog& log_of_ros2() {
  static const testing::WrittenLog log = small_log(RosEncoding::Cdr);
  return log;
}

class Mcap : public ::testing::Test {
 protected:
  std::unique_ptr<LogFile> open(const std::string& bytes, const LogOptions& options = {}) const {
    return open_ros_recording({folder_.file("drive.mcap", bytes)}, options);
  }
  std::string refusal(const std::string& bytes) const {
    return data_error([&] { open(bytes)->read(testing::small_log_requests(), {}); });
  }
  testing::TemporaryFolder folder_;
};

TEST_F(Mcap, IsReadWithAnyCompressionAndIndex) {
  for (const char* compression : {"none", "lz4", "zstd"})
    for (const std::size_t per_chunk : {0, 1, 1000})
      for (const bool index : {false, true})
        for (const bool crc : {false, true}) {
          McapOptions options;
          options.compression = compression;
          options.per_chunk = per_chunk;
          options.index = index;
          options.crc = crc;
          expect_small_log(*open(mcap_bytes(log_of_ros2(), options)));
        }
}

TEST_F(Mcap, WithoutAFooterIsReadToItsEnd) {
  McapOptions options;
  options.footer = false;
  expect_small_log(*open(mcap_bytes(log_of_ros2(), options)));
}

TEST_F(Mcap, OfRos1IsRead) {
  McapOptions options;
  options.message_encoding = "ros1";
  options.schema_encoding = "ros1msg";
  expect_small_log(*open(mcap_bytes(small_log(RosEncoding::Ros1), options)));
}

TEST_F(Mcap, LeavesOutChunksWithoutAWantedChannel) {
  McapOptions options;
  options.per_chunk = 1;
  options.compression = "zstd";
  std::string bytes = mcap_bytes(log_of_ros2(), options);
  // A chunk of /joints that cannot be decompressed: in the way only of those who want it.
  const std::size_t chunk = bytes.find("\x28\xB5\x2F\xFD", bytes.find("\x28\xB5\x2F\xFD") + 1);
  bytes[chunk] = 'x';
  const auto log = open(bytes);
  EXPECT_EQ(log->read({testing::log_request("/ticks", {"left"})}, {})[0].time_ns.size(), 30u);
  EXPECT_TRUE(
      says(data_error([&] { log->read({testing::log_request("/joints", {"position[name=left]"})}, {}); }),
           {"drive.mcap: byte ", ": chunk: zstd: "}));
}

TEST_F(Mcap, ChecksItsSums) {
  std::string bytes = mcap_bytes(log_of_ros2());
  const std::size_t at = bytes.find("left", bytes.find("left", bytes.find("left") + 1) + 1);
  bytes[at] ^= 1;
  EXPECT_TRUE(says(refusal(bytes), {"chunk: its check sum does not fit its bytes"}));
}

TEST_F(Mcap, WithWrongClaimsIsRefused) {
  const std::string begin("\x89MCAP0\r\n", 8);
  const auto chunk = [&](std::uint64_t size, const std::string& compression, const std::string& data) {
    using testing::number_bytes;
    return begin + testing::mcap_record(6, std::string(16, '\0') + number_bytes(size) + std::string(4, '\0') +
                                               number_bytes(static_cast<std::uint32_t>(compression.size())) +
                                               compression +
                                               number_bytes(static_cast<std::uint64_t>(data.size())) + data);
  };
  EXPECT_TRUE(says(refusal(chunk(943718400, "zstd", "x")),
                   {"drive.mcap: chunk at byte 8 claims 943718400 bytes, more than 67108864"}));
  EXPECT_TRUE(
      says(refusal(chunk(5, "zstd", testing::compressed("zstd", "abc"))), {"claims 5 bytes and gives 3"}));
  EXPECT_TRUE(says(refusal(chunk(5, "", "abc")), {"claims 5 bytes and gives 3"}));
  EXPECT_TRUE(says(refusal(chunk(5, "bz2", "abc")), {"compressed by 'bz2', expected none, lz4 or zstd"}));
  EXPECT_TRUE(says(refusal(chunk(3, "", testing::mcap_record(5, "abc"))), {"claims 3 bytes"}));
  EXPECT_TRUE(says(refusal(begin + testing::mcap_record(5, std::string(22, '\1'))),
                   {"channel 257, which has no record"}));
  EXPECT_TRUE(says(refusal(begin + testing::mcap_record(5, "abc")), {"a message record of 3 bytes"}));
  EXPECT_TRUE(says(refusal(begin + testing::mcap_record(4, "abc")), {"channel: found"}));
  EXPECT_TRUE(says(refusal(begin + std::string(9, '\x7f')), {"bytes expected, 0 left: the file is cut off"}));
}

TEST_F(Mcap, OtherEncodingsAreNamedAndLeftOut) {
  McapOptions options;
  options.message_encoding = "protobuf";
  auto log = open(mcap_bytes(log_of_ros2(), options));
  EXPECT_EQ(log->sources({})[0].unreadable, "messages are encoded as 'protobuf', expected cdr, ros1 or json");
  EXPECT_TRUE(says(data_error([&] { log->read(testing::small_log_requests(), {}); }),
                   {"drive.mcap: topic /ticks: messages are encoded as"}));
  options.message_encoding = "cdr";
  options.schema_encoding = "ros2idl";
  log = open(mcap_bytes(log_of_ros2(), options));
  EXPECT_EQ(log->sources({})[0].unreadable, "its definition is written in 'ros2idl', expected ros2msg");
}

TEST_F(Mcap, OfJsonIsRead) {
  testing::WrittenLog log;
  log.channels = {{"/pose", "Pose", ""}};
  for (
      const char* text :
      {R"({"header": {"stamp": {"sec": 5, "nsec": 7}}, "t": 1760000000123, "p": {"x": 1.5, "on": true}, "a": [3, 4]})",
       R"({"header": {"stamp": {"sec": 5, "nanosec": 8}}, "t": 1760000000124, "p": {"x": 2.5, "on": false},
                               "name": ["l", "r"], "a": [5, 6], "tag": "z", "e": [{"id": 3, "v": 9}]})"})
    log.messages.push_back({0, 1, text});
  McapOptions options;
  options.message_encoding = "json";
  options.schema_encoding = "jsonschema";
  const auto file = open(mcap_bytes(log, options));
  LogRequest request = testing::log_request("/pose", {"p.x", "p.on", "a[1]", "a[name=r]", "e[id=3].v"});
  request.text = {"tag"};
  const LogTable t = file->read({request}, {})[0];
  EXPECT_THAT(t.time_ns, ::testing::ElementsAre(5'000'000'007, 5'000'000'008));
  EXPECT_THAT(t.values[0], ::testing::ElementsAre(1.5, 2.5));
  EXPECT_THAT(t.values[1], ::testing::ElementsAre(1, 0));
  EXPECT_THAT(t.values[2], ::testing::ElementsAre(4, 6));
  EXPECT_THAT(t.values[3], ::testing::ElementsAre(::testing::IsNan(), 6));
  EXPECT_THAT(t.values[4], ::testing::ElementsAre(::testing::IsNan(), 9));
  EXPECT_THAT(t.text[0], ::testing::ElementsAre("", "z"));
  request.time = "t";
  EXPECT_THAT(file->read({request}, {})[0].time_ns,
              ::testing::ElementsAre(1'760'000'000'123'000'000, 1'760'000'000'124'000'000));
  const std::vector<LogField> fields = file->sources({})[0].fields;
  EXPECT_TRUE(std::any_of(fields.begin(), fields.end(),
                          [](const LogField& f) { return f.path == "p.x" && f.first == "1.5"; }));
  EXPECT_TRUE(says(testing::usage_error([&] { file->read({testing::log_request("/pose", {"p.xx"})}, {}); }),
                   {"no field 'p.xx' in Pose, did you mean 'p.x'?"}));
  log.messages = {{0, 1, std::string(100, '[')}};
  EXPECT_TRUE(says(data_error([&] { open(mcap_bytes(log, options))->read({request}, {}); }),
                   {"nested deeper than 32"}));
  log.messages = {{0, 1, "{\"p\": "}};
  EXPECT_TRUE(says(data_error([&] { open(mcap_bytes(log, options))->read({request}, {}); }),
                   {"topic /pose", "broken JSON"}));
}

// Stamps that are text: of a log that carries what another program wrote.
TEST_F(Mcap, StampsAsTextAreReadAsTablesReadThem) {
  testing::WrittenLog log;
  log.channels = {{"/line", "test_msgs/msg/Line", "string when\nfloat64 x\n"}};
  for (int k = 0; k < 3; ++k)
    log.messages.push_back({0, 5'000'000'000 + k,
                            testing::MessageBytes(RosEncoding::Cdr)
                                .text("2026-01-31T12:00:0" + std::to_string(k) + ".25+02:00")
                                .number(0.5 * k)
                                .bytes()});
  LogRequest request = testing::log_request("/line", {"x"});
  request.time = "when";
  request.time_unit = "iso8601";
  const auto file = open(mcap_bytes(log));
  const LogTable table = file->read({request}, {}).front();
  ASSERT_EQ(table.time_ns.size(), 3u);
  EXPECT_EQ(table.time_ns[2], 1'769'853'602'250'000'000);
  EXPECT_EQ(table.values[0][2], 1);
  request.time_unit = "%H:%M";
  EXPECT_TRUE(says(data_error([&] { file->read({request}, {}); }),
                   {"topic /line: when: found \"2026-01-31T12:00:00.25+02:00\"", "a time as \"%H:%M\""}));
  request.time_unit = "fortnight";
  EXPECT_THROW(file->read({request}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace odobench
