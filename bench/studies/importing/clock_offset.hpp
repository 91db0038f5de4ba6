// By how much the clock of a reference runs ahead of the wheels' clock.
#pragma once

#include <optional>

#include "datasets/import/logs/log_curves.hpp"
#include "datasets/import/logs/log_map.hpp"

namespace odobench {

struct ClockOffset {
  double seconds = 0;      // positive: the reference's stamps are too large
  double correlation = 0;  // of the peak
  double at_zero = 0;      // of no offset; 0 where the stamps share no time
};

// |yaw rate| of the reference against that of odometry with nominal parameters, both as differences over
// 0.1 s on a grid of 10 ms: the lag of the largest normalised correlation (means taken out on the overlap,
// which is at least a quarter of the shorter), a parabola through the peak. Lags up to 5 s,
// or all where the stamps share no time. Nothing where the
// robot never turns faster than 0.1 rad/s, where the logs overlap by less than 2 s, where the peak lies at
// the end of the lags, and of logs of more than 14 hours. The height of the peak proves little.
std::optional<ClockOffset> clock_offset(const log_import::LogMap& map, const log_import::LogCurves& curves);

}  // namespace odobench
