// How much work a verb is about to do: bounded before it begins, and told when it will take long.
#pragma once

#include <string>

#include "bench/studies/watcher.hpp"

namespace odobench {

// Samples of simulated recordings: ticks of the odometry and of the motion capture. Measured on one core of
// 2020: 3 microseconds and 230 bytes each.
inline constexpr double kMostSamplesHeld = 20e6;  // 4.6 GB
inline constexpr double kMostSamplesMade = 4e9;   // three hours
inline constexpr double kSecondsPerSample = 3e-6;

// Of the motor robot, with the texts that are written of a sample.
inline constexpr double kSecondsPerStep = 1e-6, kSecondsPerMotorSample = 15e-6;

// A verb that is expected to take longer than this on one thread says so.
inline constexpr double kLong_s = 5;

struct WorkSize {
  std::string what;  // "12 drives 5 times"; begins the note and the refusal
  double held = 0;   // samples in memory at once
  double made = 0;   // and altogether
};

// Throws std::invalid_argument "WHAT: about 1.3e+10 samples, expected at most ..." beyond one of the two
// limits.
void require_size(const WorkSize& size);

// A note for work of that many seconds, if it is long.
void announce(const std::string& text, double seconds, Watcher& watcher);
void announce(const WorkSize& size, Watcher& watcher);

}  // namespace odobench
