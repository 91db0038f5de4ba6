// Small recordings of ROS messages, written by the tests themselves: serialised messages, bags, MCAP files
// and rosbag2's tables. Independent of the readers but for the name of an encoding.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/logs/ros/messages/message_definition.hpp"

namespace odobench::testing {

// Little-endian bytes of a number.
template <class T>
std::string number_bytes(T value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

// A message in the making, field by field.
class MessageBytes {
 public:
  explicit MessageBytes(RosEncoding encoding, bool big_endian = false);

  template <class T>
  MessageBytes& number(T value) {
    std::string bytes = number_bytes(value);
    if (big_endian_) bytes.assign(bytes.rbegin(), bytes.rend());
    if (encoding_ == RosEncoding::Cdr)
      while ((bytes_.size() - 4) % sizeof value != 0) bytes_ += '\0';
    bytes_ += bytes;
    return *this;
  }
  MessageBytes& text(std::string_view value);
  MessageBytes& count(std::size_t elements) { return number(static_cast<std::uint32_t>(elements)); }
  MessageBytes& numbers(const std::vector<double>& values);     // float64[]
  MessageBytes& texts(const std::vector<std::string>& values);  // string[]
  MessageBytes& stamp(std::int64_t ns);
  MessageBytes& header(std::int64_t ns, std::string_view frame);

  const std::string& bytes() const { return bytes_; }

 private:
  RosEncoding encoding_;
  bool big_endian_;
  std::string bytes_;
};

// The text of a type: `main` and the standard messages behind it.
std::string full_definition(const std::string& main, RosEncoding encoding,
                            const std::vector<std::string>& parts);

struct WrittenChannel {
  std::string topic, type, definition;
};
struct WrittenMessage {
  std::size_t channel = 0;
  std::int64_t log_ns = 0;
  std::string data;
};
struct WrittenLog {
  RosEncoding encoding = RosEncoding::Cdr;
  std::vector<WrittenChannel> channels;
  std::vector<WrittenMessage> messages;
};

// 30 messages of each of /ticks (test_msgs/Ticks: header, int32 left, right), /joints (JointState: in turns
// two joints in changing order and one that is alone) and /tf (two frames per message). Message k has stamp
// 1,000 s + k * 10 ms, is logged 3 ms later, and has left = k, right = -2 k, position of "left" k / 2, of
// "right" k / 4, x of odom -> base k / 8, of map -> odom 7.
WrittenLog small_log(RosEncoding encoding);
inline constexpr int kSmallLogMessages = 30;
inline constexpr std::int64_t kSmallLogBegin = 1'000'000'000'000, kSmallLogStep = 10'000'000,
                              kSmallLogDelay = 3'000'000;

// "none", "bz2", "lz4" (frame), "zstd".
std::string compressed(std::string_view compression, std::string_view bytes);

// `per_chunk`: messages; 0: no chunks.
std::string bag_bytes(const WrittenLog& log, const std::string& compression, std::size_t per_chunk = 20);
std::string bag_record(const std::vector<std::pair<std::string, std::string>>& header, std::string_view data);

struct McapOptions {
  std::string compression = "none";
  std::size_t per_chunk = 20;  // messages; 0: no chunks
  bool index = true;           // summary with channels and chunk indexes
  bool footer = true;
  bool crc = true;
  std::string message_encoding = "cdr", schema_encoding = "ros2msg";
};
std::string mcap_bytes(const WrittenLog& log, const McapOptions& options = {});
std::string mcap_record(unsigned char op, std::string_view body);

struct Rosbag2Options {
  bool definitions = true;
  bool compress_messages = false;
};
void write_rosbag2(const std::filesystem::path& file, const WrittenLog& log,
                   const Rosbag2Options& options = {});
// Statements on a database that may be new.
void run_sql(const std::filesystem::path& file, const std::string& statements);

}  // namespace odobench::testing
