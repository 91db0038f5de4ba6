// The rows that a map asks of the logs of one group, by source, in the order of time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/stop.hpp"
#include "datasets/import/logs/log_groups.hpp"
#include "datasets/import/logs/log_map.hpp"

namespace odobench::log_import {

struct SourceRows {
  std::vector<std::int64_t> time_ns;                  // strictly increasing
  std::map<std::string, std::vector<double>> values;  // by path
  // Stamp of the message minus the log's time: median, and the distance from it that 99 % keep.
  std::optional<double> delay_median_s;
  double delay_99_s = 0;
};

class LogRows {
 public:
  std::map<std::string, SourceRows> rows;              // by name of the source
  std::map<std::string, std::filesystem::path> files;  // likewise
  std::vector<std::string> notes;

  const SourceRows& of(const std::string& source) const { return rows.at(source); }
  const std::filesystem::path& file_of(const std::string& source) const { return files.at(source); }
  bool has(const MappedField& field) const;
  // One value per row; of a quaternion its yaw, atan2(2 (w z + x y), w^2 + x^2 - y^2 - z^2), not unwrapped.
  std::vector<double> values(const MappedField& field) const;
};

LogRows read_rows(const LogMap& map, const LogGroup& group, const LogOptions& options, const Stop& stop);

}  // namespace odobench::log_import
