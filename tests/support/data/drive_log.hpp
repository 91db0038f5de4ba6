// A drive of a two-wheeled robot as logs: wheel counts and motion capture, each with a clock of its own.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace odobench::testing {

// The true robot: wheels of 50.4 mm (left) and 49.85 mm (right), 412 mm apart; 1,000 counts a turn, rounded
// down. It stands for a second, drives 9 s with turns to both sides, and stands for a second; `stop_s` more
// seconds in the middle where it stands, too.
struct DriveLog {
  double clock_ahead_s = 0.137;  // of the capture
  double noise_m = 1e-4;
  double stop_s = 0;
  double gap_from_s = -1, gap_to_s = -1;  // without capture
  int bits = 0;                           // of the counters: 0, they never run over
  bool y_to_the_right = false;            // of the capture's frame
  int left_sign = 1;                      // -1: counts backwards
  double begin_s = 1.7e9;                 // of the wheels' clock
  // Of a reference that is another odometry: its heading's walk [rad per square root of a metre], its place.
  double drift = 0, mount_x = 0, mount_y = 0;
  unsigned drift_seed = 1;

  static constexpr double kLeft = 0.0504, kRight = 0.04985, kTrack = 0.412;

  struct State {
    double x = 1, y = -0.5, theta = 0.6, left = 0, right = 0;
  };
  double seconds() const { return 11 + stop_s; }

  // Speed and yaw rate at t; smooth, zero at the ends of each half.
  void motion(double t, double& v, double& w) const {
    const double middle = 5.5;
    if (t > middle) t = std::max(middle, t - stop_s);
    const double s = t < 1 || t > 10 ? 0 : std::pow(std::sin((t - 1) * 3.14159265358979 / 4.5), 2);
    v = 0.4 * s;
    w = (t < middle ? 0.9 : -0.7) * s;
  }

  // States every millisecond, by the midpoint rule.
  std::vector<State> states() const {
    std::vector<State> all{State{}};
    for (int k = 0; k < static_cast<int>(seconds() * 1000); ++k) {
      double v = 0, w = 0;
      motion((k + 0.5) * 1e-3, v, w);
      State s = all.back();
      const double middle = s.theta + w * 5e-4;
      s.x += v * 1e-3 * std::cos(middle);
      s.y += v * 1e-3 * std::sin(middle);
      s.theta += w * 1e-3;
      s.left += (v - w * kTrack / 2) / kLeft * 1e-3;
      s.right += (v + w * kTrack / 2) / kRight * 1e-3;
      all.push_back(s);
    }
    return all;
  }

  // The same motion step by step, each turned by what has drifted, from a frame of its own.
  std::vector<State> drifted(const std::vector<State>& truth) const {
    std::vector<State> all;
    double x = 7, y = -2, off = 1.9;
    std::mt19937 random(drift_seed);
    std::normal_distribution<double> walk(0, drift);
    for (std::size_t k = 0; k < truth.size(); ++k) {
      if (k > 0) {
        const double dx = truth[k].x - truth[k - 1].x, dy = truth[k].y - truth[k - 1].y;
        if (drift > 0) off += std::sqrt(std::hypot(dx, dy)) * walk(random);
        x += std::cos(off) * dx - std::sin(off) * dy;
        y += std::sin(off) * dx + std::cos(off) * dy;
      }
      const double theta = truth[k].theta + off, c = std::cos(theta), s = std::sin(theta);
      all.push_back({x + c * mount_x - s * mount_y, y + s * mount_x + c * mount_y, theta, 0, 0});
    }
    return all;
  }

  std::string wheels() const {
    std::string csv = "stamp_ns,left_ticks,right_ticks\n";
    const std::vector<State> all = states();
    const std::int64_t wrap = std::int64_t{1} << bits;
    const auto counts = [&](double angle) {
      auto n = static_cast<std::int64_t>(std::floor(angle * 1000 / (2 * 3.14159265358979)));
      return bits > 0 ? ((n % wrap) + wrap) % wrap : n;
    };
    for (std::size_t k = 0; k < all.size(); k += 20)
      csv += fmt::format(
          "{},{},{}\n",
          static_cast<std::int64_t>(begin_s) * 1'000'000'000 + static_cast<std::int64_t>(k) * 1'000'000,
          counts(left_sign * all[k].left), counts(all[k].right));
    return csv;
  }

  std::string capture() const {
    std::mt19937 random(7);
    std::normal_distribution<double> noise(0, 1);
    std::string csv = "time [s],x [mm],y [mm],yaw [deg]\n";
    std::vector<State> all = states();
    if (drift != 0 || mount_x != 0 || mount_y != 0) all = drifted(all);
    for (std::size_t k = 5; k < all.size(); k += 10) {
      const double t = static_cast<double>(k) * 1e-3;
      if (t > gap_from_s && t < gap_to_s) continue;
      csv += fmt::format("{:.6f},{:.4f},{:.4f},{:.5f}\n", begin_s + t + clock_ahead_s,
                         1e3 * (all[k].x + noise_m * noise(random)),
                         (y_to_the_right ? -1e3 : 1e3) * (all[k].y + noise_m * noise(random)),
                         (all[k].theta + noise_m * noise(random)) * 180 / 3.14159265358979);
    }
    return csv;
  }
};

}  // namespace odobench::testing
