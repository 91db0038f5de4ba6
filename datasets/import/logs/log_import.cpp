#include "datasets/import/logs/log_import.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "base/files.hpp"
#include "base/sha256.hpp"
#include "base/text.hpp"
#include "datasets/import/csv/csv_drive.hpp"
#include "datasets/import/csv/csv_files.hpp"

namespace odobench::log_import {
namespace fs = std::filesystem;

namespace {

std::vector<fs::path> files_in(const fs::path& log) {
  if (!fs::is_directory(log)) return {log};
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(log))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

class DatasetMaker {
 public:
  DatasetMaker(const LoadedLogs& loaded, const Adjustment& adjustment, SetSensors* sensors)
      : loaded_(loaded), adjustment_(adjustment), sensors_(sensors) {}

  Dataset make() {
    const LogMap& map = loaded_.map;
    set_.name = map.name;
    set_.description = map.description;
    set_.robot = map.robot;
    set_.reference = map.kind;
    set_.provenance = {map.source, map.licence, "bench import", {}};
    set_.provenance.files.push_back({fs::path(map.file).filename().string(), loaded_.map_sha256});
    for (const SourceFile& file : loaded_.files) set_.provenance.files.push_back(file);
    for (std::size_t k = 0; k < loaded_.logs.size(); ++k)
      add(loaded_.logs[k],
          k < adjustment_.offsets.size() ? adjustment_.offsets[k] : std::map<std::string, double>{});
    if (next_name_ < map.names.size())
      set_.notes.push_back(
          fmt::format("{} names of drives in the map, {} drives: names from \"{}\" on are not used",
                      map.names.size(), next_name_, shown(map.names[next_name_])));
    if (!map.poses.empty()) join_end_poses(loaded_.poses, map.poses.string(), logs_, set_);
    return std::move(set_);
  }

 private:
  void add(const LogCurves& log, const std::map<std::string, double>& offsets) {
    LogDrives drives = make_drives(loaded_.map, log, adjustment_.mount, offsets);
    for (const std::string& text : log.notes) set_.notes.push_back(printable(text));
    for (const std::string& text : drives.notes) set_.notes.push_back(printable(text));
    for (std::size_t k = 0; k < drives.recordings.size(); ++k) {
      Recording& r = drives.recordings[k];
      name(r, drives.names[k].empty() ? log.id : drives.names[k]);
      if (sensors_ != nullptr && !drives.sensors[k].empty()) (*sensors_)[r.id] = std::move(drives.sensors[k]);
      set_.recordings.push_back(std::move(r));
      logs_.push_back(log.files);
    }
  }

  void name(Recording& r, const std::string& usual) {
    const std::vector<std::string>& names = loaded_.map.names;
    const std::string& given = next_name_ < names.size() ? names[next_name_] : usual;
    ++next_name_;
    const csv_import::NameParts parts = csv_import::name_parts(given + ".log");
    r.trajectory = printable(parts.trajectory);
    r.repetition = std::max(1, parts.number);
    while (!taken_.insert({r.trajectory, r.repetition}).second) ++r.repetition;
    r.id = fmt::format("{}_{}", csv_import::as_id(r.trajectory), r.repetition);
    while (!ids_.insert(r.id).second) r.id += '_';
    if (std::none_of(set_.trajectories.begin(), set_.trajectories.end(),
                     [&](const Trajectory& t) { return t.name == r.trajectory; }))
      set_.trajectories.push_back({r.trajectory, ""});
  }

  const LoadedLogs& loaded_;
  const Adjustment& adjustment_;
  SetSensors* sensors_;
  Dataset set_;
  std::vector<std::vector<fs::path>> logs_;  // of each recording
  std::size_t next_name_ = 0;
  std::set<std::pair<std::string, int>> taken_;
  std::set<std::string> ids_;
};

}  // namespace

LoadedLogs load_logs(const std::string& map_text, const fs::path& map_file, const std::vector<fs::path>& logs,
                     const LogOptions& options, const Stop& stop, const fs::path& poses) {
  LoadedLogs loaded;
  loaded.map = parse_log_map(map_text, map_file.string(), poses);
  loaded.map_sha256 = sha256(map_text);
  if (const fs::path& table = loaded.map.poses; !table.empty()) {
    const std::string rows = read_file(table);
    loaded.poses = parse_end_poses(rows, table.string());
    loaded.files.push_back({printable(table.filename().string()), sha256(rows)});
  }
  for (const LogGroup& group : group_logs(loaded.map, logs)) {
    stop.check();
    loaded.logs.push_back(read_curves(loaded.map, group, options, stop));
  }
  for (const fs::path& log : logs)
    for (const fs::path& file : files_in(log)) {
      stop.check();
      loaded.files.push_back({printable(file.filename().string()), sha256_of_file(file)});
    }
  return loaded;
}

Adjustment adjustment_of(const LogMap& map) {
  return {{}, {map.mount_x, map.mount_y, map.mount_yaw}};
}

Dataset make_dataset(const LoadedLogs& loaded, const Adjustment& adjustment, SetSensors* sensors) {
  return DatasetMaker(loaded, adjustment, sensors).make();
}

std::vector<std::string> describe_drives(const Dataset& dataset) {
  std::vector<std::string> lines;
  for (const Recording& r : dataset.recordings) lines.push_back(csv_import::describe_drive(r));
  return lines;
}

}  // namespace odobench::log_import
