// Bringing signals of two loggers onto one clock: stamps as exact integer microseconds, headings without
// jumps, linear interpolation.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace odobench {

// A stamp that is not later than the one before it is set 1 us after it, when it goes back by at most this
// much: loggers give two messages the same stamp now and then, or swap neighbours. More (less than a sample
// of any log here) is a fault of the clock.
inline constexpr std::int64_t kLargestBackstep_us = 10'000;

struct StampRepair {
  std::size_t moved = 0;  // stamps set 1 us after their predecessor
  // First stamp that goes back by more than kLargestBackstep_us (0-based); stamps.size() when none does.
  std::size_t fault = 0;
};

// Makes stamps strictly increasing in place, up to the fault.
StampRepair make_increasing(std::span<std::int64_t> stamps);

// Removes jumps of more than pi between neighbours by adding multiples of 2 pi; the first angle stays. In
// place, rad.
void unwrap(std::span<double> angles);

// Linear interpolation of (time, value) at the stamps `at`, linear extrapolation by the outermost two points
// beyond the ends; at a given stamp the given value exactly. time: strictly increasing, at least two; at:
// increasing. Differences of stamps are formed in integers.
std::vector<double> interpolate(std::span<const std::int64_t> time, std::span<const double> value,
                                std::span<const std::int64_t> at);

}  // namespace odobench
