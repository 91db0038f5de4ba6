// Wheel odometry fused with synthetic sensors: the study behind `bench fuse`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/stop.hpp"
#include "bench/studies/watcher.hpp"
#include "problems/instruction_set.hpp"
#include "reports/kinds/fusion/fusion_tables.hpp"
#include "reports/records/tracks.hpp"

namespace odobench {

struct FusionStudy {
  std::string data;                     // path of set.json; empty: the demo set
  std::vector<std::string> parameters;  // files or names, as of read_judged_parameters()
  std::vector<std::string> filters;     // comma lists; empty: none,ekf,ukf
  std::string sensors;                  // file
  std::string odometry_noise;           // as wheel_noise_choice() takes it
  std::optional<std::uint64_t> seed;    // instead of the file's
  int threads = 0;                      // 0: one per core; results do not depend on them
  std::optional<InstructionSet> kernel;
  bool keep_tracks = false;
};

struct FusionRuns {
  std::vector<RunRecord> records;  // filter by filter, in each the parameter sets
  std::vector<FusionRow> rows;     // of the same
  TrackSet tracks;                 // with keep_tracks one per record, else the reference alone
  Table sensors;                   // which they are
};

// Throws std::invalid_argument on names that are none, DataError on bad files and where a filter breaks down,
// Interruption when it is to stop.
FusionRuns fuse_recordings(const FusionStudy& study, Watcher& watcher, const Stop& stop);

}  // namespace odobench
