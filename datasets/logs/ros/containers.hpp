// The files that ROS messages are recorded in: ROS 1 bags (wiki.ros.org/Bags/Format/2.0), MCAP
// (mcap.dev/spec) and rosbag2's SQLite tables. Each gives its channels and messages from front to back.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/stop.hpp"
#include "datasets/logs/log_file.hpp"
#include "datasets/logs/ros/messages/message_definition.hpp"

namespace odobench {

struct RosChannel {
  std::string topic;
  std::string type;                               // as the file writes it
  std::shared_ptr<const std::string> definition;  // null where the file has none
  RosEncoding encoding = RosEncoding::Cdr;
  std::string unreadable;  // "" or why its messages cannot be read
};

// Where a message stands, for refusals: in MCAP files and bags the byte of its record or chunk, in tables its
// row.
struct MessagePlace {
  const std::filesystem::path* file = nullptr;
  std::uint64_t number = 0;
  bool row = false;
};

// Gets what a container has.
class RosSink {
 public:
  virtual ~RosSink() = default;
  // Of every channel once, before its first message: a number for it, negative when its messages are not
  // wanted.
  virtual int channel(const RosChannel& channel) = 0;
  // `bytes` are valid during the call.
  virtual void message(int channel, std::int64_t log_ns, std::string_view bytes,
                       const MessagePlace& place) = 0;

  std::int64_t seen = 0;  // messages so far, wanted or not
  std::vector<std::string> notes;
};

// One file of a recording.
class RosContainer {
 public:
  virtual ~RosContainer() = default;
  virtual const char* format() const = 0;
  virtual const std::filesystem::path& file() const = 0;
  // Throws DataError, LogCutOff where the file ends early, Interruption.
  virtual void walk(RosSink& sink, const Stop& stop) const = 0;
};

// Told by the first bytes.
bool is_bag(std::string_view head);
bool is_mcap(std::string_view head);
bool is_sqlite(std::string_view head);

std::unique_ptr<RosContainer> open_bag(const std::filesystem::path& file, const LogOptions& options);
std::unique_ptr<RosContainer> open_mcap(const std::filesystem::path& file, const LogOptions& options);
// Of a compressed file (.db3.zstd), too, which is decompressed into a file of the temporary folder that has
// no name any more while it is read.
std::unique_ptr<RosContainer> open_rosbag2(const std::filesystem::path& file, const LogOptions& options);

// By the file's first bytes. DataError when it is none of them.
std::unique_ptr<RosContainer> open_ros_container(const std::filesystem::path& file,
                                                 const LogOptions& options);

// Bytes that a file may decompress to, counted.
class DecompressedBytes {
 public:
  DecompressedBytes(const std::filesystem::path& file, std::int64_t most) : file_(file), most_(most) {}
  void add(std::uint64_t bytes);  // throws DataError

 private:
  std::filesystem::path file_;
  std::int64_t most_, so_far_ = 0;
};

}  // namespace odobench
