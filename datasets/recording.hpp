// One drive of a robot with four steered and driven wheels, on one clock: reference pose (motion capture) and
// wheel signals at the same stamps. SI units and radians. Plain data; the readers guarantee what is stated
// here.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace odobench {

inline constexpr std::size_t kWheelCount = 4;

// Wheels in the order 1 front-left, 2 rear-left, 3 rear-right, 4 front-right. All columns have the length of
// time_us.
struct Recording {
  std::string id;                                            // unique in its data set, e.g. "line_x_1"
  std::string trajectory;                                    // name of the driven trajectory, e.g. "line_x"
  int repetition = 0;                                        // 1-based
  std::vector<std::int64_t> time_us;                         // strictly increasing, starts at 0, microseconds
  std::vector<double> x, y;                                  // reference position, m
  std::vector<double> theta;                                 // reference heading, rad, unwrapped
  std::array<std::vector<double>, kWheelCount> steering;     // steering angle d_i, rad
  std::array<std::vector<double>, kWheelCount> wheel_speed;  // wheel speed w_i, rad/s

  std::size_t size() const { return time_us.size(); }
};

}  // namespace odobench
