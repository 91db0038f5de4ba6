// Recordings with one parameter set and one filter, and synthetic sensors: what `bench fuse` and `bench tune`
// share.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/stop.hpp"
#include "bench/catalogue/problem_factory.hpp"
#include "problems/fusion/sensors_file.hpp"
#include "reports/kinds/fusion/fusion_tables.hpp"
#include "reports/records/tracks.hpp"

namespace odobench {

// One way to estimate: odometry alone, or a filter.
struct FilterChoice {
  std::string name;  // none, ekf, ukf, ekf-smoothed, ukf-smoothed, ekf-literal
  bool filtered = true;
  FilterKind kind = FilterKind::Extended;
  bool smooth = false;
  bool literal = false;
};

// Throws std::invalid_argument on an unknown or repeated name.
std::vector<FilterChoice> parse_filters(const std::vector<std::string>& lists);

struct FusedRow {
  FusionRow row;
  std::vector<RecordingError> errors;
  PoseTrack track;  // all recordings, one after the other
};

// All recordings with one parameter set and filter; `streams` per recording. `threads` does not change the
// result. Throws Interruption between two recordings.
FusedRow fuse_all(std::span<const Recording> recordings, const Vector& z, const FilterChoice& filter,
                  const SensorsFile& sensors, const std::vector<std::vector<SensorStream>>& streams,
                  int threads, const Stop& stop);

// Streams of every recording, made side by side. How many measurements they have is asked before
// (require_measurements).
std::vector<std::vector<SensorStream>> all_streams(const SensorsFile& file,
                                                   std::span<const Recording> recordings, std::uint64_t seed,
                                                   int threads, const Stop& stop);
// The table that says that the sensors are synthetic, and what they are; `wheels`: notes on what the filter
// believes of them.
Table sensor_table(const SensorsFile& file, std::uint64_t seed, const std::string& dataset,
                   const std::vector<std::string>& wheels);

}  // namespace odobench
