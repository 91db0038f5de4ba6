#include "datasets/logs/formats.hpp"

#include <fmt/format.h>

#include "base/files.hpp"
#include "datasets/logs/ros/ros_logs.hpp"
#include "datasets/logs/tables/table_logs.hpp"

namespace odobench {
namespace fs = std::filesystem;

const std::vector<LogFormat>& log_formats() {
  static const std::vector<LogFormat> all = [] {
    std::vector<LogFormat> list = ros_log_formats();
    list.insert(list.end(), table_log_formats().begin(), table_log_formats().end());
    return list;
  }();
  return all;
}

std::unique_ptr<LogFile> open_log(const fs::path& path, const LogOptions& options) {
  std::string head;
  if (!fs::is_directory(path)) {
    constexpr std::size_t kHead = 4096;
    struct Enough {};
    try {
      read_pieces(path, kHead, [&](std::string_view piece) {
        head = piece;
        throw Enough();
      });
    } catch (const Enough&) {
    }
  }
  for (const LogFormat& format : log_formats())
    if (format.recognises(path, head)) return format.open(path, options);
  throw DataError(fmt::format(
      "{}: of no known format of logs, expected a ROS bag, MCAP, rosbag2, CSV, MAT, npz, JSON lines "
      "or a trajectory; convert Parquet with pandas.read_parquet(F).to_csv(...), old bags with "
      "rosbag fix, others with ros2 bag convert",
      shown_path(path)));
}

}  // namespace odobench
