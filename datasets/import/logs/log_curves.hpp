// The values of a log that a map names, over time: SI units, one line of time for all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/stop.hpp"
#include "datasets/import/logs/log_groups.hpp"
#include "datasets/import/logs/log_map.hpp"

namespace odobench::log_import {

// A value at stamps; between them a straight line. Seconds since LogCurves::begin_ns, strictly increasing.
struct Curve {
  std::string name;    // of the signal
  std::string source;  // whose clock it has
  std::vector<double> time, value;
  double delay_s = 0;  // from stamp to log, the median, where it lies between 0 and 1 s

  // At t, which lies within the stamps (the value at the nearer end, else). `at`: where the last search
  // ended, from 0; searches that go forward take constant time.
  double at(double t, std::size_t& hint) const;
  double median_step() const;
};

// One log, or the files of a drive that belong together.
struct LogCurves {
  std::string id;  // of the file's name
  std::vector<std::filesystem::path> files;
  // Stamp of t = 0: of the first row by its own clock, of the reference or, without, of the first signal.
  std::int64_t begin_ns = 0;
  Curve x, y, heading;  // the tracked frame; m, rad, unwrapped; empty without reference
  // The robot's signals in its order: a drive's angle since some time (rad), whatever it was measured as; a
  // steering angle (rad).
  std::vector<Curve> signals;
  std::vector<Curve> others;        // gyro.z, accel.x, ...
  std::vector<std::string> report;  // a line per signal: count, rate, longest gap, delay
  std::vector<std::string> notes;   // what was passed over, repaired or assumed, with counts
};

// Reads each file of the group once. `options`: for all files, beside what the sources say of their format.
// Stamps that repeat are left out; rows up to a second out of order are sorted; both are counted. DataError
// for fields that a log has not (with the place in the map and the nearest name), for stamps that go back by
// more, for a wheel or a reference without two rows.
LogCurves read_curves(const LogMap& map, const LogGroup& group, const LogOptions& options, const Stop& stop);

}  // namespace odobench::log_import
