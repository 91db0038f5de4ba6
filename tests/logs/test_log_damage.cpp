// Damaged and hostile recordings: whatever the bytes are, a DataError or a result, in bounded memory.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <zstd.h>

#include <random>

#include "datasets/logs/ros/ros_logs.hpp"
#include "tests/support/data_error.hpp"
#include "tests/support/run_process.hpp"
#include "tests/support/small_log.hpp"

namespace odobench {
namespace {

using testing::data_error;
using testing::says;

// Of this process so far [MB].
double largest_memory() {
  struct ::rusage usage {};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

constexpr bool kMemoryIsMeasured =
#if defined(__SANITIZE_ADDRESS__)
    false;
#else
    true;
#endif

struct Format {
  const char* name;
  std::string (*bytes)(const testing::TemporaryFolder& folder);
};

testing::WrittenLog few_messages(RosEncoding encoding) {
  testing::WrittenLog log = testing::small_log(encoding);
  log.messages.resize(9);
  return log;
}
template <int compression>
std::string bag(const testing::TemporaryFolder&) {
  return testing::bag_bytes(few_messages(RosEncoding::Ros1),
                            compression == 0   ? "none"
                            : compression == 1 ? "bz2"
                                               : "lz4",
                            4);
}
template <int compression>
std::string mcap(const testing::TemporaryFolder&) {
  testing::McapOptions options;
  options.compression = compression == 0 ? "none" : compression == 1 ? "zstd" : "lz4";
  options.per_chunk = 4;
  options.crc = false;  // so that the damage reaches the messages
  return testing::mcap_bytes(few_messages(RosEncoding::Cdr), options);
}
template <bool file, bool message>
std::string rosbag2(const testing::TemporaryFolder& folder) {
  testing::Rosbag2Options options;
  options.compress_messages = message;
  std::filesystem::remove(folder / "make.db3");
  testing::write_rosbag2(folder / "make.db3", few_messages(RosEncoding::Cdr), options);
  const std::string bytes = testing::content(folder / "make.db3");
  return file ? testing::compressed("zstd", bytes) : bytes;
}

// Under sanitizers each takes ten times as long.
constexpr std::size_t kCuts = kMemoryIsMeasured ? 3000 : 500;
constexpr int kFlips = kMemoryIsMeasured ? 2000 : 400;

class Damaged : public ::testing::TestWithParam<Format> {
 protected:
  // Reads and lists; true when nothing was refused. What is not a refusal ends the test.
  bool survives(const std::string& bytes, const LogOptions& options = {}) const {
    // A new file: some file systems write one that is shortened and filled again to the disc at once.
    std::filesystem::remove(folder_ / "damaged");
    const std::string file = folder_.file("damaged", bytes);
    bool fine = true;
    for (const bool list : {false, true}) {
      try {
        const auto log = open_ros_recording({file}, options);
        if (list)
          log->sources({});
        else
          log->read(testing::small_log_requests(), {});
      } catch (const DataError& e) {
        fine = false;
        EXPECT_TRUE(says(e.what(), {"damaged"}));
      } catch (const std::invalid_argument&) {  // names may be damaged, too
        fine = false;
      }
    }
    return fine;
  }
  testing::TemporaryFolder folder_;
};

TEST_P(Damaged, CutAtEveryByteIsRefusedOrRead) {
  const std::string whole = GetParam().bytes(folder_);
  LogOptions keep;
  keep.keep_cut = true;
  const std::size_t step =
      std::max<std::size_t>(1, whole.size() / kCuts);  // SQLite's have whole pages of nothing
  for (std::size_t size = 0; size < whole.size(); size += step) {
    survives(whole.substr(0, size));
    if (size % 7 == 0) survives(whole.substr(0, size), keep);
  }
  EXPECT_TRUE(survives(whole));
  EXPECT_TRUE(!kMemoryIsMeasured || largest_memory() < 300) << largest_memory();
}

TEST_P(Damaged, WithAnyBytesFlippedIsRefusedOrRead) {
  const std::string whole = GetParam().bytes(folder_);
  std::mt19937 random(5);
  int fine = 0;
  for (int k = 0; k < kFlips; ++k) {
    std::string bytes = whole;
    for (auto flips = 1 + random() % 3; flips > 0; --flips)
      bytes[random() % bytes.size()] = static_cast<char>(random());
    fine += survives(bytes) ? 1 : 0;
  }
  EXPECT_GT(fine, 0);
  EXPECT_LT(fine, kFlips);
  EXPECT_TRUE(!kMemoryIsMeasured || largest_memory() < 300) << largest_memory();
}

INSTANTIATE_TEST_SUITE_P(Formats, Damaged,
                         ::testing::Values(Format{"bag", bag<0>}, Format{"bag_bz2", bag<1>},
                                           Format{"bag_lz4", bag<2>}, Format{"mcap", mcap<0>},
                                           Format{"mcap_zstd", mcap<1>}, Format{"mcap_lz4", mcap<2>},
                                           Format{"rosbag2", rosbag2<false, false>},
                                           Format{"rosbag2_zstd_file", rosbag2<true, false>},
                                           Format{"rosbag2_zstd_message", rosbag2<false, true>}),
                         [](const auto& test) { return std::string(test.param.name); });

// 30 kB that decompress to 900 MiB of zeros.
std::string zstd_bomb() {
  ZSTD_CCtx* context = ZSTD_createCCtx();
  const std::string zeros(1 << 20, '\0');
  std::string out(1 << 20, '\0');
  ZSTD_outBuffer output{out.data(), out.size(), 0};
  for (int k = 0; k < 900; ++k) {
    ZSTD_inBuffer input{zeros.data(), zeros.size(), 0};
    ZSTD_compressStream2(context, &output, &input, k == 899 ? ZSTD_e_end : ZSTD_e_continue);
  }
  ZSTD_freeCCtx(context);
  out.resize(output.pos);
  return out;
}

class Bombs : public Damaged {
 protected:
  std::string refusal(const std::string& bytes, const LogOptions& options = {}) const {
    return data_error([&] {
      open_ros_recording({folder_.file("bomb", bytes)}, options)->read(testing::small_log_requests(), {});
    });
  }
};

TEST_F(Bombs, OfZstdAreRefusedInLittleMemory) {
  const std::string bomb = zstd_bomb();
  ASSERT_LT(bomb.size(), 200'000u);
  using testing::number_bytes;
  for (const std::uint64_t claim : {std::uint64_t{900} << 20, std::uint64_t{64} << 20, std::uint64_t{100}}) {
    const std::string chunk =
        std::string("\x89MCAP0\r\n", 8) +
        testing::mcap_record(6, std::string(16, '\0') + number_bytes(claim) + std::string(4, '\0') +
                                    number_bytes(4u) + "zstd" +
                                    number_bytes(static_cast<std::uint64_t>(bomb.size())) + bomb);
    EXPECT_TRUE(
        says(refusal(chunk), {claim > (std::uint64_t{64} << 20) ? "claims 943718400 bytes, more than 67108864"
                                                                : "decompresses to more than"}));
  }
  // A message of rosbag2, and a whole file.
  testing::WrittenLog log = testing::small_log(RosEncoding::Cdr);
  log.messages.resize(1);
  log.messages[0].data = bomb;
  testing::write_rosbag2(folder_ / "message.db3", log);
  EXPECT_TRUE(says(refusal(testing::content(folder_ / "message.db3")),
                   {"message 1: decompresses to more than 67108864 bytes"}));
  LogOptions options;
  options.max_bytes = 100 << 20;
  EXPECT_TRUE(says(refusal(bomb, options), {"decompresses to more than 104857600 bytes (--max-bytes)"}));
  EXPECT_TRUE(!kMemoryIsMeasured || largest_memory() < 300) << largest_memory();
}

TEST_F(Bombs, ManyChannelsOfOneLongDefinitionShareIt) {
  testing::WrittenLog log;
  std::string definition;
  for (int i = 0; i < 1900; ++i) definition += fmt::format("uint8[] field_of_a_long_name_{}\n", i);
  std::string bytes("\x89MCAP0\r\n", 8);
  using testing::number_bytes;
  const auto text = [](const std::string& t) {
    return number_bytes(static_cast<std::uint32_t>(t.size())) + t;
  };
  bytes += testing::mcap_record(
      3, number_bytes(std::uint16_t{1}) + text("a/A") + text("ros2msg") + text(definition));
  for (int i = 0; i < 65535; ++i)
    bytes +=
        testing::mcap_record(4, number_bytes(static_cast<std::uint16_t>(i)) + number_bytes(std::uint16_t{1}) +
                                    text(fmt::format("/{}", i)) + text("cdr") + text(""));
  EXPECT_EQ(open_ros_recording({folder_.file("bomb", bytes)}, {})->sources({}).size(), 65535u);
  EXPECT_TRUE(!kMemoryIsMeasured || largest_memory() < 300) << largest_memory();
}

TEST_F(Bombs, SortingOfAnEndlessTableStops) {
  // Generated columns, triggers and virtual tables are none of a recorder's.
  testing::run_sql(folder_ / "virtual.db3",
                   "CREATE TABLE topics(id INTEGER PRIMARY KEY, name, type, serialization_format);"
                   "CREATE VIRTUAL TABLE messages USING fts4(topic_id, timestamp, data);");
  EXPECT_TRUE(says(refusal(testing::content(folder_ / "virtual.db3")),
                   {"'messages' is a virtual table, expected a table"}));
}

}  // namespace
}  // namespace odobench
