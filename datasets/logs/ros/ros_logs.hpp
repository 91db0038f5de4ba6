// Logs of ROS 1 and ROS 2: bags, MCAP files, rosbag2's SQLite files and folders of these.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "datasets/logs/log_file.hpp"

namespace odobench {

const std::vector<LogFormat>& ros_log_formats();

// Several files, or folders of rosbag2, as one recording: topics with one name are one source, its rows in
// the order of the files.
std::unique_ptr<LogFile> open_ros_recording(const std::vector<std::filesystem::path>& files,
                                            const LogOptions& options);

}  // namespace odobench
