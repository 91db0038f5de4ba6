// Runs for the relative-entropy filter as a user's files would hold them.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <ostream>
#include <sstream>
#include <string>

namespace odobench::testing {

// A rigid robot on a circle at constant speed, without noise: an accelerometer that turns with it measures
// omega x v, the frame's own velocity does not change. What the filter should find is known exactly.
struct CircleRun {
  bool right_first =
      true;  // wheels front right, rear right, rear left, front left; else rear left, front left, ...
  double vx = 0.5, vy = 0.1, omega = 0.3, dt = 0.1;  // m/s in the robot's frame, rad/s counter-clockwise, s
  double length = 0.775, width = 0.55;
  int rows = 30;

  std::string data() const {
    std::string text =
        "time_s,enc1_m,enc2_m,enc3_m,enc4_m,ax_m_s2,ay_m_s2,yaw_rate_rad_s,psi1_rad,psi2_rad,psi3_rad,psi4_"
        "rad\n";
    const double a = length / 2, b = width / 2;
    const std::array<std::array<double, 2>, 4> right{{{a, -b}, {-a, -b}, {-a, b}, {a, b}}};
    const std::array<std::array<double, 2>, 4> left{{{-a, b}, {a, b}, {a, -b}, {-a, -b}}};
    const auto& places = right_first ? right : left;
    for (int n = 0; n < rows; ++n) {
      std::string wheels, angles;
      for (const auto& place : places) {
        const double x = (vx - omega * place[1]) * dt, y = (vy + omega * place[0]) * dt;
        wheels += fmt::format(",{}", std::hypot(x, y));
        angles += fmt::format(",{}", std::atan2(y, x));
      }
      text += fmt::format("{:.1f}{},{},{},{}{}\n", n * dt, wheels, -omega * vy, omega * vx, omega, angles);
    }
    return text;
  }
  // In the filter's frame, the robot's turned by -alpha.
  std::string truth() const {
    const double alpha = std::atan2(width, length), c = std::cos(alpha), s = std::sin(alpha);
    std::string text = "sx_m,sy_m,dtheta_deg,ax_m_s2,ay_m_s2\n";
    for (int n = 0; n < rows; ++n)
      text += fmt::format("{},{},{},0,0\n", (vx * c - vy * s) * dt, (vy * c + vx * s) * dt,
                          omega * dt * 180 / std::numbers::pi);
    return text;
  }
  double wheel_distance() const { return std::hypot(length, width) / 2; }
};

// `rows` rows of the named layout with a little of everything in them, the rotation per step in degrees.
inline void write_plain_run(std::ostream& out, int rows) {
  out << "time_s,enc1_m,enc2_m,enc3_m,enc4_m,ax_m_s2,ay_m_s2,yaw_step_deg\n";
  for (int n = 0; n < rows; ++n) {
    const double wave = std::sin(0.7 * n);
    out << fmt::format("{:.2f},{},{},{},{},{},{},{}\n", 0.1 * n, 0.05 + 0.001 * wave, 0.05 - 0.002 * wave,
                       0.049 + 0.001 * (n % 100), 0.051, 0.1 * wave, -0.05 * wave, 0.5 + 0.3 * wave);
  }
}
inline std::string plain_run(int rows) {
  std::ostringstream text;
  write_plain_run(text, rows);
  return text.str();
}

}  // namespace odobench::testing
