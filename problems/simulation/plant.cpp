#include "problems/simulation/plant.hpp"

#include <algorithm>
#include <cmath>

#include "problems/simulation/recording_simulator.hpp"

namespace odobench::simulate {
namespace {

constexpr double kStep_s = 0.004;      // at most
constexpr double kMoving = 0.02;       // rad/s
constexpr double kSlipTime_s = 0.5;    // correlation time of random slip
constexpr double kWanderSpread = 2.2;  // of its logarithm over recordings
constexpr double kLargestWander = 20;  // times the median
constexpr double kLargestBias = 3;     // standard deviations

// A stationary first-order process: what its next value is, `share` of it kept.
double next_wander(double now, double share, double sigma, Random& noise) {
  return share * now + noise.normal(sigma * std::sqrt(1 - share * share));
}

}  // namespace

Plant::Plant(const RecordingScenario& scenario, const std::string& drive, const Pose& start, Random& noise)
    : scenario_(scenario), pose_(start) {
  const auto gains = scenario.slip.gains.find(drive);
  if (gains != scenario.slip.gains.end()) gains_ = gains->second;
  const Control& c = scenario.control;
  for (std::size_t i = 0; i < kWheelCount; ++i) {
    bias_[i] = std::clamp(noise.normal(1), -kLargestBias, kLargestBias) * c.steering_bias;
    wander_sigma_[i] = c.steering_wander * std::min(std::exp(noise.normal(kWanderSpread)), kLargestWander);
    lost_[i] = noise.normal(scenario.slip.fixed);
  }
}

void Plant::steer_at_once(const PerWheel& steering) {
  steering_ = steering;
}

WheelState Plant::wheels() const {
  WheelState w;
  for (std::size_t i = 0; i < kWheelCount; ++i) {
    w.steering[i] = steering_[i] + bias_[i] + wander_[i];
    w.speed[i] = speed_[i];
  }
  return w;
}

void Plant::advance(const WheelState& command, double seconds, Random& noise) {
  const Control& c = scenario_.control;
  const bool moving =
      std::any_of(speed_.begin(), speed_.end(), [](double w) { return std::abs(w) > kMoving; });
  const double wander_kept = std::exp(-seconds / c.wander_time_s),
               slip_kept = std::exp(-seconds / kSlipTime_s);
  for (std::size_t i = 0; i < kWheelCount; ++i) {
    if (moving) wander_[i] = next_wander(wander_[i], wander_kept, wander_sigma_[i], noise);
    if (scenario_.slip.random > 0)
      slipping_[i] = next_wander(slipping_[i], slip_kept, scenario_.slip.random, noise);
  }
  const int steps = std::max(1, static_cast<int>(std::ceil(seconds / kStep_s - 1e-9)));
  const double step = seconds / steps;
  // What is left of a difference after a step of each lag.
  const double left = c.wheel_lag_s > 0 ? std::exp(-step / c.wheel_lag_s) : 0;
  for (int k = 0; k < steps; ++k) {
    WheelState actual;
    for (std::size_t i = 0; i < kWheelCount; ++i) {
      const double before = speed_[i];
      lagged_[i] = command.speed[i] + (lagged_[i] - command.speed[i]) * left;
      speed_[i] = lagged_[i] + (speed_[i] - lagged_[i]) * left;
      const double most = c.steering_rate * step;
      steering_[i] += std::clamp(command.steering[i] - steering_[i], -most, most);
      const double mean = (before + speed_[i]) / 2;
      angles_[i] += mean * step;
      actual.steering[i] = steering_[i] + bias_[i] + wander_[i];
      actual.speed[i] = mean * (1 - lost_[i] - slipping_[i]);
    }
    Twist t = true_twist(scenario_.truth, actual);
    t.vx *= gains_.linear;
    t.vy *= gains_.linear;
    t.omega *= gains_.angular;
    if (moving) t.omega += scenario_.slip.yaw_bias;
    pose_ = moved(pose_, t, step);
  }
}

}  // namespace odobench::simulate
