// A first map.json for CSV files, from the names of their columns.
#pragma once

#include <string>
#include <vector>

#include "base/error.hpp"

namespace odobench {

struct CsvProposal {
  std::string map;                   // JSON that import_csv() takes once every null is replaced
  std::vector<std::string> reasons;  // a line each
};

// Units are what names end in ("left_rad_s", "x [mm]", "yaw (deg)", "stamp_ns"), the columns' meaning is what
// is left: time, x, y, theta, yaw or heading, left and right, wheel 1, 2, ..., steering. The unit of a time
// without one is that in which steps of the first file are those of a log of 1 to 1000 Hz. Odometry's own
// poses are not taken for a reference. null is what cannot be known: lengths, counts of a turn, units and
// columns without a name that says so. Throws what csv_files() and the reader of CSV throw; DataError for a
// file with another header than the first.
CsvProposal propose_csv_map(const std::vector<std::string>& items);

}  // namespace odobench
