// Logs to data sets, and a look at what stands in them: the study behind `bench import LOG...`.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/stop.hpp"
#include "bench/studies/watcher.hpp"
#include "datasets/dataset.hpp"
#include "datasets/logs/log_file.hpp"
#include "datasets/sensor_rows.hpp"
#include "reports/render/table.hpp"

namespace odobench {

struct LogStudy {
  std::vector<std::filesystem::path> logs;
  std::string map;                 // its text
  std::filesystem::path map_file;  // for messages and the set's provenance
  LogOptions options;
  std::filesystem::path poses = {};  // table of end poses, in the place of the map's
};

struct ImportedLogs {
  Dataset dataset;                  // what was repaired or left out stands in its notes
  SetSensors sensors;               // gyro and camera, where the map names them
  std::vector<std::string> report;  // signals, clocks, drives; a line each
};

// Whether a file is a set.json, and so no log.
bool is_dataset(const std::filesystem::path& file);

// Warnings go to the watcher. Throws DataError, std::invalid_argument, Interruption.
ImportedLogs import_logs(const LogStudy& study, Watcher& watcher, const Stop& stop);

// "sources": format, rows, rate, longest gap, delay of each; "fields": type and first value of each.
std::vector<Table> log_tables(const std::filesystem::path& log, const LogOptions& options, const Stop& stop);

}  // namespace odobench
