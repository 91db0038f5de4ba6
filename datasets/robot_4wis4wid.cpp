#include "datasets/robot_4wis4wid.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace odobench {

Robot robot_4wis4wid() {
  constexpr std::array<double, kWheelCount> a = {kHalfTrack, -kHalfTrack, -kHalfTrack, kHalfTrack};
  constexpr std::array<double, kWheelCount> b = {kHalfTrack, kHalfTrack, -kHalfTrack, -kHalfTrack};
  Robot robot;
  const auto add = [&robot](char letter, std::size_t wheel, double nominal) {
    const double x = nominal * 0.95, y = nominal * 1.05;
    robot.parameters.push_back(
        {fmt::format("{}{}", letter, wheel + 1), "m", nominal, std::min(x, y), std::max(x, y)});
  };
  for (std::size_t i = 0; i < kWheelCount; ++i) add('a', i, a[i]);
  for (std::size_t i = 0; i < kWheelCount; ++i) add('b', i, b[i]);
  for (std::size_t i = 0; i < kWheelCount; ++i) add('r', i, kWheelRadius);
  return robot_of_class("4wis4wid", robot.parameters);
}

Recording recording_4wis4wid() {
  Recording recording;
  for (std::size_t i = 0; i < kWheelCount; ++i)
    recording.signals.push_back({fmt::format("steering.{}", i + 1), SignalKind::Angle, {}});
  for (std::size_t i = 0; i < kWheelCount; ++i)
    recording.signals.push_back({fmt::format("wheel.{}", i + 1), SignalKind::Speed, {}});
  return recording;
}

std::vector<Trajectory> trajectories_4wis4wid() {
  return {
      {"line_x", "straight line of 4 m along x, wheels ahead, 0.05 m/s"},
      {"line_y", "straight line of 4 m along y, wheels turned by pi/2 rad, 0.05 m/s"},
      {"circle_ccw", "one circle of radius 0.5 m, counter-clockwise, 2 pi / 80 rad/s"},
      {"circle_cw", "one circle of radius 0.5 m, clockwise, 2 pi / 80 rad/s"},
      {"rotation_ccw", "one turn on the spot, counter-clockwise, 2 pi / 40 rad/s"},
      {"rotation_cw", "one turn on the spot, clockwise, 2 pi / 40 rad/s"},
  };
}

}  // namespace odobench
