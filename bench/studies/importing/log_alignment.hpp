// What a map leaves to the logs themselves: clock offsets and the mount of the tracked frame.
#pragma once

#include <string>
#include <vector>

#include "base/stop.hpp"
#include "datasets/import/logs/log_import.hpp"

namespace odobench {

struct LogAlignment {
  log_import::Adjustment adjustment;
  std::vector<std::string> report;    // what was estimated, applied or not
  std::vector<std::string> warnings;  // clocks that differ while the map says that they do not
};

// Offsets that the map wants estimated: first clock_offset(), then the minimum over the offset of the lowest
// mean square that `lm` reaches with the robot's parameters and the mount free (Brent's method, +-20 ms), log
// by log. A mount that is to be estimated is that of the fit to all logs. Throws DataError where an offset is
// wanted of drives that never turn, or of wheels and reference alike.
LogAlignment align_logs(const log_import::LoadedLogs& loaded, const Stop& stop);

}  // namespace odobench
