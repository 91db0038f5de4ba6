// The columns of a recording by name, in the order in which files hold them, and what every one must satisfy.
#pragma once

#include <fmt/format.h>

#include <optional>
#include <string>

#include "datasets/recording.hpp"

namespace odobench {

inline constexpr std::size_t kValueColumns = 3 + 2 * kWheelCount;

// Calls visit(name, unit, std::vector<double>&) for x, y, theta, steering_1..4, wheel_speed_1..4 (time_us is
// apart: it holds integers).
template <class R, class Visit>
void for_each_value_column(R& recording, Visit visit) {
  visit(std::string("x"), "m", recording.x);
  visit(std::string("y"), "m", recording.y);
  visit(std::string("theta"), "rad", recording.theta);
  for (std::size_t i = 0; i < kWheelCount; ++i)
    visit(fmt::format("steering_{}", i + 1), "rad", recording.steering[i]);
  for (std::size_t i = 0; i < kWheelCount; ++i)
    visit(fmt::format("wheel_speed_{}", i + 1), "rad/s", recording.wheel_speed[i]);
}

// The first thing wrong with a recording's columns.
struct ColumnFault {
  std::string column;                 // as above, or "time_us"
  std::optional<std::size_t> sample;  // 0-based; none when the column as a whole is wrong
  std::string what;                   // "found nan, expected a finite number"
};

// At least two samples, all columns equally long, stamps from 0 strictly increasing, values finite.
std::optional<ColumnFault> find_fault(const Recording& recording);

}  // namespace odobench
