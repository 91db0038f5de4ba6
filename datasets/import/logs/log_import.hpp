// From logs and a map to a data set.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/stop.hpp"
#include "datasets/dataset.hpp"
#include "datasets/import/logs/end_poses.hpp"
#include "datasets/import/logs/log_curves.hpp"
#include "datasets/import/logs/log_drives.hpp"
#include "datasets/import/logs/log_map.hpp"

namespace odobench::log_import {

// Logs that were read, so that sets by several clock offsets and mounts can be made of them.
struct LoadedLogs {
  LogMap map;
  std::string map_sha256;
  std::vector<EndPose> poses;  // of map.poses
  std::vector<LogCurves> logs;
  std::vector<SourceFile> files;  // with their sums; of a folder those in it
};

// Reads logs by a map, whose text is that of `map_file`, and the table of end poses (`poses`, or the map's).
// Throws DataError, std::invalid_argument for logs that fit no source, Interruption.
LoadedLogs load_logs(const std::string& map_text, const std::filesystem::path& map_file,
                     const std::vector<std::filesystem::path>& logs, const LogOptions& options,
                     const Stop& stop, const std::filesystem::path& poses = {});

// What was found out about the logs and not said by the map.
struct Adjustment {
  // Of each log: source -> how much its clock runs ahead, beside what the map says [s]. Empty: nothing.
  std::vector<std::map<std::string, double>> offsets;
  Mount mount;  // in the place of the map's
};
Adjustment adjustment_of(const LogMap& map);

// Drives are called by the map's names, their marks, else by their log: "square_2" is repetition 2 of
// "square"; further drives of one log get the next free number. Of a map with end poses only drives that have
// one are left. `sensors` gets what gyro and camera measured in them, where it is given.
Dataset make_dataset(const LoadedLogs& loaded, const Adjustment& adjustment, SetSensors* sensors = nullptr);

// One line per drive: id, samples, seconds, metres, degrees turned to the left and to the right.
std::vector<std::string> describe_drives(const Dataset& dataset);

}  // namespace odobench::log_import
