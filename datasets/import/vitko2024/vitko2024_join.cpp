#include "datasets/import/vitko2024/vitko2024_join.hpp"

#include "datasets/import/vitko2024/synchronise.hpp"
#include "datasets/robot_4wis4wid.hpp"

namespace odobench::vitko2024 {

Recording join(CaptureLog capture, const WheelLog& wheels) {
  unwrap(capture.yaw);
  const auto kept = [](auto& values) {
    values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(kDroppedSamples));
    return std::move(values);
  };
  Recording r = recording_4wis4wid();
  const std::vector<std::int64_t> stamps = kept(capture.time_us);
  r.reference.x = kept(capture.x);
  r.reference.y = kept(capture.y);
  r.reference.theta = kept(capture.yaw);
  for (std::size_t i = 0; i < kWheelCount; ++i) {
    // Along the shorter arc: a sensor with the range (-pi, pi] reports 3.13 and -3.13 for neighbours.
    std::vector<double> steering = wheels.steering[i];
    unwrap(steering);
    steering_of(r, i) = interpolate(wheels.time_us, steering, stamps);
    wheel_speed_of(r, i) = interpolate(wheels.time_us, wheels.wheel_speed[i], stamps);
  }
  r.time_us = stamps;
  for (std::int64_t& t : r.time_us) t -= stamps.front();
  return r;
}

}  // namespace odobench::vitko2024
