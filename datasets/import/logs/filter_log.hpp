// The rows of the relative-entropy filter out of a log: four encoders, an accelerometer and a gyro, each with
// stamps of its own, on one even grid.
//
// The stamps are t(k) = t(0) + k dt from the first stamp of the first wheel that all channels share. With a
// wheel's angle A, the gyro's rate w and an acceleration a as straight lines between their stamps
//     wheel = r (A(t(k)) - A(t(k-1))),   rotation = int w over (t(k-1), t(k)),   steering at their middle,
//     acceleration = a(t(k)), or its mean over (t(k) - dt/2, t(k) + dt/2) where it comes twice a step or more
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "datasets/entropy/filter_run.hpp"
#include "datasets/import/logs/log_curves.hpp"
#include "datasets/import/logs/log_map.hpp"

namespace odobench::log_import {

struct FilterLogOptions {
  std::optional<double> dt;  // s; none: the median step of the slowest wheel, to the microsecond
  bool resample = false;     // gaps of up to ten dt are bridged by straight lines
};

struct FilterLog {
  std::string id;
  double dt = 0;
  std::vector<FilterRow> rows;  // time_s since the first stamp of the log, line: the number of the row
  // Of the robot's nominal wheels, which stand in the corners of a rectangle [m].
  double length = 0, width = 0, wheel_distance = 0;
  std::int64_t filled = 0;         // rows inside bridged gaps
  std::vector<std::string> notes;  // rates, what was passed over, the grid
};

// Throws std::invalid_argument naming the map's place for a robot whose wheels are not four that roll without
// sliding, one in each quarter and within 5 % of the corners of a rectangle round the origin, for a map
// without gyro.z, accel.x and accel.y, and for clocks that are to be estimated; DataError for channels that a
// log has not or that share no time, and for gaps longer than limits.max_wheel_gap_s (and 3 usual steps)
// unless they are bridged.
FilterLog filter_log(const LogMap& map, const LogCurves& curves, const FilterLogOptions& options);

}  // namespace odobench::log_import
