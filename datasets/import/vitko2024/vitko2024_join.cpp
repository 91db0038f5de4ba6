#include "datasets/import/vitko2024/vitko2024_join.hpp"

#include "datasets/import/vitko2024/synchronise.hpp"

namespace odobench::vitko2024 {

Recording join(CaptureLog capture, const WheelLog& wheels) {
  unwrap(capture.yaw);
  const auto kept = [](auto& values) {
    values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(kDroppedSamples));
    return std::move(values);
  };
  Recording r;
  const std::vector<std::int64_t> stamps = kept(capture.time_us);
  r.x = kept(capture.x);
  r.y = kept(capture.y);
  r.theta = kept(capture.yaw);
  for (std::size_t i = 0; i < kWheelCount; ++i) {
    // Along the shorter arc: a sensor with the range (-pi, pi] reports 3.13 and -3.13 for neighbours.
    std::vector<double> steering = wheels.steering[i];
    unwrap(steering);
    r.steering[i] = interpolate(wheels.time_us, steering, stamps);
    r.wheel_speed[i] = interpolate(wheels.time_us, wheels.wheel_speed[i], stamps);
  }
  r.time_us = stamps;
  for (std::int64_t& t : r.time_us) t -= stamps.front();
  return r;
}

}  // namespace odobench::vitko2024
