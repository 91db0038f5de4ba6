// Made-up wheel signals for tests of the calibration problem: no physics, every parameter excited.
#pragma once

#include <cmath>
#include <vector>

#include "datasets/recording.hpp"
#include "datasets/robot_4wis4wid.hpp"
#include "problems/problem.hpp"

namespace odobench::testing {

inline std::vector<ParameterInfo> nominal_robot() {
  std::vector<ParameterInfo> list;
  const double sign[3][4] = {{1, -1, -1, 1}, {1, 1, -1, -1}, {1, 1, 1, 1}};
  for (int kind = 0; kind < 3; ++kind)
    for (int i = 0; i < 4; ++i) {
      const double nominal = sign[kind][i] * (kind == 2 ? 0.0254 : 0.1125);
      const double p = nominal * 0.95, q = nominal * 1.05;
      list.push_back({std::string(1, "abr"[kind]) + std::to_string(i + 1), "m", nominal, std::min(p, q),
                      std::max(p, q)});
    }
  return list;
}

// `samples` >= 1 samples of about `step_s` seconds; deterministic in all arguments.
inline Recording synthetic_recording(int samples, double step_s, int variant) {
  Recording r = recording_4wis4wid();
  r.id = "synthetic_" + std::to_string(variant);
  r.trajectory = "synthetic";
  r.repetition = variant;
  std::int64_t t = 0;
  for (int k = 0; k < samples; ++k) {
    const double s = k * step_s;
    r.time_us.push_back(t);
    t += static_cast<std::int64_t>(step_s * 1e6 * (1.0 + 0.4 * std::sin(1.7 * k + variant))) + 1;
    r.reference.x.push_back(0.04 * s + 0.01 * std::sin(s + variant));
    r.reference.y.push_back(0.02 * std::sin(0.3 * s));
    r.reference.theta.push_back(0.5 + 0.05 * s + 0.1 * std::sin(0.2 * s + variant));
    for (std::size_t i = 0; i < kWheelCount; ++i) {
      const auto w = static_cast<double>(i);
      steering_of(r, i).push_back(0.6 * std::sin(0.4 * s + w + variant) + 0.1 * w);
      wheel_speed_of(r, i).push_back(1.5 + std::cos(0.7 * s + 2 * w) * (i == 2 ? -1 : 1));
    }
  }
  return r;
}

}  // namespace odobench::testing
