#include "datasets/logs/ros/ros_logs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>

#include "base/files.hpp"
#include "datasets/logs/ros/decompress.hpp"
#include "datasets/logs/ros/log_input.hpp"
#include "datasets/logs/ros/ros_log.hpp"

namespace odobench {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMostRecordingFiles = 65536;
constexpr std::size_t kRosHead = 16;

class RosLog : public LogFile {
 public:
  RosLog(RosContainers files, const LogOptions& options) : files_(std::move(files)), options_(options) {}
  std::string format() const override { return files_.front()->format(); }
  std::vector<LogSource> sources(const Stop& stop) const override {
    return survey_recording(files_, options_, stop);
  }
  std::vector<LogTable> read(const std::vector<LogRequest>& requests, const Stop& stop) const override {
    return read_recording(files_, requests, options_, stop);
  }

 private:
  RosContainers files_;
  LogOptions options_;
};

bool ends_with(std::string_view text, std::string_view end) {
  return text.size() >= end.size() && text.substr(text.size() - end.size()) == end;
}

// "run" and 10 of "run_10.db3.zstd": `_10` comes behind `_9`.
std::pair<std::string, std::uint64_t> numbered_name(const fs::path& file) {
  const std::string name = file.filename().string();
  std::string stem = name.substr(0, name.find(".db3"));
  stem = stem.substr(0, stem.find(".mcap"));
  const auto last = stem.find_last_not_of("0123456789");
  const std::size_t digits = last == std::string::npos ? 0 : last + 1;
  std::uint64_t number = 0;
  const char* end = stem.data() + stem.size();
  if (std::from_chars(stem.data() + digits, end, number).ec != std::errc{}) number = 0;
  return {stem.substr(0, digits), number};
}

// The files of a rosbag2 folder in their order.
std::vector<fs::path> rosbag2_files(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (ends_with(name, ".db3") || ends_with(name, ".db3.zstd") || ends_with(name, ".mcap"))
      files.push_back(entry->path());
    if (files.size() > kMostRecordingFiles) break;
  }
  if (error) throw DataError(fmt::format("{}: cannot be read: {}", shown_path(folder), error.message()));
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return std::pair(numbered_name(a), a) < std::pair(numbered_name(b), b);
  });
  return files;
}

bool is_folder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

template <bool (*is_format)(std::string_view)>
bool recognises_file(const fs::path& path, const std::string& head) {
  return !is_folder(path) && is_format(head);
}

bool is_compressed_sqlite(std::string_view head) {
  return is_sqlite(head) || is_zstd(head);
}

bool recognises_folder(const fs::path& path, const std::string&) {
  if (!is_folder(path)) return false;
  try {
    return !rosbag2_files(path).empty();
  } catch (const DataError&) {
    return false;
  }
}

std::unique_ptr<LogFile> open_one(const fs::path& path, const LogOptions& options) {
  return open_ros_recording({path}, options);
}

}  // namespace

void DecompressedBytes::add(std::uint64_t bytes) {
  so_far_ += static_cast<std::int64_t>(bytes);
  if (so_far_ > most_)
    throw DataError(
        fmt::format("{}: decompresses to more than {} bytes (--max-bytes)", shown_path(file_), most_));
}

std::unique_ptr<RosContainer> open_ros_container(const fs::path& file, const LogOptions& options) {
  LogInput input(file);
  const std::string_view head = input.take_some(kRosHead);
  if (is_bag(head)) return open_bag(file, options);
  if (is_mcap(head)) return open_mcap(file, options);
  if (is_compressed_sqlite(head)) return open_rosbag2(file, options);
  fail_at(file, 0, "found other bytes, expected a ROS 1 bag, an MCAP file or a rosbag2 file");
}

std::unique_ptr<LogFile> open_ros_recording(const std::vector<fs::path>& files, const LogOptions& options) {
  RosContainers containers;
  const auto add = [&](const fs::path& file) { containers.push_back(open_ros_container(file, options)); };
  for (const fs::path& path : files) {
    if (!is_folder(path)) {
      add(path);
      continue;
    }
    for (const fs::path& file : rosbag2_files(path)) add(file);
  }
  if (containers.empty())
    throw DataError(fmt::format("{}: found no .db3, .db3.zstd or .mcap file, expected a recording of rosbag2",
                                files.empty() ? "" : shown_path(files.front())));
  return std::make_unique<RosLog>(std::move(containers), options);
}

const std::vector<LogFormat>& ros_log_formats() {
  static const std::vector<LogFormat> formats{
      {"ROS 1 bag", recognises_file<is_bag>, open_one},
      {"MCAP", recognises_file<is_mcap>, open_one},
      {"rosbag2 (sqlite3)", recognises_file<is_compressed_sqlite>, open_one},
      {"rosbag2 folder", recognises_folder, open_one}};
  return formats;
}

}  // namespace odobench
