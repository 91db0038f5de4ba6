#include "problems/simulation/logging.hpp"

#include <algorithm>
#include <cmath>

namespace odobench::simulate {
namespace {

constexpr double kTurning = 0.02;                             // rad/s; a standing wheel reads exactly zero
constexpr double kPollJitter_s = 0.0003;                      // of the capture's receiver
constexpr double kQueue_low_s = 2e-6, kQueue_high_s = 34e-6;  // between messages taken in one go

double to_grid(double value, double quantum) {
  return quantum > 0 ? std::round(value / quantum) * quantum : value;
}

std::int64_t microseconds(double seconds) {
  return std::llround(seconds * 1e6);
}

Pose pose_at(const std::vector<Pose>& path, double tick_s, double t) {
  const double at = std::clamp(t / tick_s, 0.0, static_cast<double>(path.size() - 1));
  const auto k = std::min(static_cast<std::size_t>(at), path.size() - 2);
  const double part = at - static_cast<double>(k);
  const Pose &a = path[k], &b = path[k + 1];
  return {a.x + part * (b.x - a.x), a.y + part * (b.y - a.y), a.theta + part * (b.theta - a.theta)};
}

}  // namespace

const WheelMessage& WheelLogger::record(double t, const WheelState& wheels, const PerWheel& angles,
                                        std::vector<WheelMessage>& messages) {
  const Odometry& o = options_;
  WheelMessage m;
  for (std::size_t i = 0; i < kWheelCount; ++i) {
    const double noise = noise_.normal(o.speed_noise);
    const bool turning = std::abs(wheels.speed[i]) > kTurning;
    m.speed[i] = turning ? to_grid(wheels.speed[i] + noise, o.speed_quantum) : 0.0;
    m.steering[i] = to_grid(wheels.steering[i], o.steering_quantum);
    m.angle[i] = angles[i];
  }
  m.stamp_us = microseconds(t + noise_.normal(o.stamp_jitter_s)) + kRobotClockAhead_us;
  double delay =
      noise_.uniform(0, 1) < o.on_time ? std::abs(noise_.normal(o.on_time_s)) : noise_.exponential(o.delay_s);
  if (noise_.uniform(0, 1) < o.stall_probability) delay += noise_.uniform(o.stall_s.low, o.stall_s.high);
  free_at_s_ = std::max(t + delay, free_at_s_ + noise_.uniform(kQueue_low_s, kQueue_high_s));
  m.received_us = microseconds(free_at_s_);
  messages.push_back(m);
  return messages.back();
}

void log_capture(const Capture& o, const std::vector<Pose>& path, double tick_s, Random& noise,
                 std::vector<CaptureMessage>& messages) {
  const double duration = static_cast<double>(path.size() - 1) * tick_s;
  const double loss = noise.uniform(o.loss.low, o.loss.high), phase = noise.uniform(0, 1) / o.rate_hz;
  double free_at = 0;
  for (std::int64_t k = 0;; ++k) {
    const double t = phase + static_cast<double>(k) / o.rate_hz;
    if (t > duration) break;
    Pose pose = pose_at(path, tick_s, t);
    pose.x += noise.normal(o.position_noise);
    pose.y += noise.normal(o.position_noise);
    pose.theta += noise.normal(o.heading_noise);
    const bool lost = noise.uniform(0, 1) < loss;
    double arrival = t + (o.delay_s > 0 ? noise.exponential(o.delay_s) : 0.0);
    if (noise.uniform(0, 1) < o.stall_probability) arrival += noise.uniform(o.stall_s.low, o.stall_s.high);
    if (lost) continue;
    if (o.poll_s > 0)
      arrival = std::ceil(arrival / o.poll_s) * o.poll_s + noise.uniform(-kPollJitter_s, kPollJitter_s);
    free_at = std::max(arrival, free_at + noise.uniform(kQueue_low_s, kQueue_high_s));
    messages.push_back({microseconds(free_at), microseconds(t), k, pose});
  }
}

}  // namespace odobench::simulate
