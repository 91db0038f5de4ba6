// The robot of J. Vitko's thesis (University of Zagreb, 2024): four independently steered and driven wheels,
// 1 front-left, 2 rear-left, 3 rear-right, 4 front-right; x forward, y left.
#pragma once

#include <array>

#include "datasets/dataset.hpp"

namespace odobench {

inline constexpr std::size_t kWheelCount = 4;
inline constexpr double kHalfTrack = 0.1125;    // |a_i| = |b_i| nominal, m
inline constexpr double kWheelRadius = 0.0254;  // r_i nominal, m

// Parameters a1..a4, b1..b4, r1..r4 in metres: wheel i stands at (a_i, b_i), its radius is r_i. Bounds are 5
// % to either side, nominal * 0.95 and nominal * 1.05 (the other way round where nominal is negative).
Robot robot_4wis4wid();

// The six drives of the thesis in the order of its tables: line_x, line_y, circle_ccw, circle_cw,
// rotation_ccw, rotation_cw.
std::vector<Trajectory> trajectories_4wis4wid();

// A recording without samples that has its signals: steering.1..4 (angles), wheel.1..4 (speeds).
Recording recording_4wis4wid();

// The signals of wheel i (0-based) of such a recording: angle d_i in rad, speed w_i in rad/s.
inline const std::vector<double>& steering_of(const Recording& recording, std::size_t i) {
  return recording.signals.at(i).values;
}
inline std::vector<double>& steering_of(Recording& recording, std::size_t i) {
  return recording.signals.at(i).values;
}
inline const std::vector<double>& wheel_speed_of(const Recording& recording, std::size_t i) {
  return recording.signals.at(kWheelCount + i).values;
}
inline std::vector<double>& wheel_speed_of(Recording& recording, std::size_t i) {
  return recording.signals.at(kWheelCount + i).values;
}

}  // namespace odobench
