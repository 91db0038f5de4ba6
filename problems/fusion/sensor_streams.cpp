#include "problems/fusion/sensor_streams.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/random.hpp"

namespace odobench {
namespace {

// Pose and yaw rate of the reference at any instant, by the local line.
class Truth {
 public:
  Truth(const Recording& recording, double smooth_s) : r_(recording), width_(smooth_s) {
    time_.reserve(r_.size());
    for (const std::int64_t t : r_.time_us) time_.push_back(static_cast<double>(t) * 1e-6);
  }

  struct Sample {
    Eigen::Vector3d pose;
    double rate = 0;
  };

  Sample at(double t) const {
    auto begin = std::lower_bound(time_.begin(), time_.end(), t - width_);
    auto end = std::upper_bound(time_.begin(), time_.end(), t + width_);
    // Never fewer than three samples: the nearest ones where stamps are sparse.
    while (end - begin < 3 && (begin != time_.begin() || end != time_.end())) {
      if (begin != time_.begin()) --begin;
      if (end != time_.end()) ++end;
    }
    double count = 0, mean = 0, spread = 0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero(), slope = Eigen::Vector3d::Zero();
    for (auto i = begin; i != end; ++i) {
      count += 1;
      mean += *i - t;
      sum += value(static_cast<std::size_t>(i - time_.begin()));
    }
    mean /= count;
    sum /= count;
    for (auto i = begin; i != end; ++i) {
      const double d = *i - t - mean;
      spread += d * d;
      slope += d * (value(static_cast<std::size_t>(i - time_.begin())) - sum);
    }
    if (spread > 0) slope /= spread;
    return {sum - mean * slope, slope[2]};
  }

 private:
  Eigen::Vector3d value(std::size_t k) const {
    return {r_.reference.x[k], r_.reference.y[k], r_.reference.theta[k]};
  }
  const Recording& r_;
  double width_;
  std::vector<double> time_;
};

void check(const StreamTiming& t) {
  require(t.rate_hz > 0 && t.rate_hz <= 1e5, "rate_hz", t.rate_hz, "more than 0 and at most 1e5");
  require(t.delay_s >= 0, "delay_s", t.delay_s, "a finite number >= 0");
  require(t.missing >= 0 && t.missing < 1, "missing", t.missing, "at least 0 and below 1");
  require(t.smooth_s > 0, "smooth_s", t.smooth_s, "a finite number > 0");
}

// Calls sample(seconds since the sample before, truth) -> value for each stamp
// of the stream; lost ones are made and dropped, so that the others do not
// depend on `missing`.
template <class Sample>
std::vector<Measurement> stream(const Recording& recording, const StreamTiming& timing, Random& noise,
                                Sample sample) {
  const Truth truth(recording, timing.smooth_s);
  const double phase = noise.uniform();
  const auto delay = static_cast<std::int64_t>(std::llround(timing.delay_s * 1e6));
  std::vector<Measurement> list;
  double before = static_cast<double>(recording.time_us.front()) * 1e-6;
  for (std::int64_t k = 0;; ++k) {
    const std::int64_t t =
        recording.time_us.front() + std::llround((static_cast<double>(k) + phase) / timing.rate_hz * 1e6);
    if (t > recording.time_us.back()) return list;
    const double seconds = static_cast<double>(t) * 1e-6;
    const Eigen::Vector3d value = sample(seconds - before, truth.at(seconds));
    before = seconds;
    if (noise.uniform() >= timing.missing) list.push_back({t, t + delay, value});
  }
}

}  // namespace

std::vector<Measurement> synthetic_camera(const Recording& recording, const CameraErrors& errors,
                                          const StreamTiming& timing, std::uint64_t seed) {
  check(timing);
  for (const auto& [name, value] :
       {std::pair("scale", errors.scale), std::pair("position_walk", errors.position_walk),
        std::pair("heading_walk", errors.heading_walk), std::pair("position_noise", errors.position_noise),
        std::pair("heading_noise", errors.heading_noise)})
    require(value >= 0, name, value, "a finite number >= 0");
  require(std::abs(errors.scale_mean) < 1, "scale_mean", errors.scale_mean, "between -1 and 1");
  Random noise(seed);
  const double scale = 1 + errors.scale_mean + noise.normal(errors.scale);
  const Truth start(recording, timing.smooth_s);
  Eigen::Vector3d last = start.at(static_cast<double>(recording.time_us.front()) * 1e-6).pose;
  Eigen::Vector2d position = last.head<2>();
  double drift = 0;
  return stream(recording, timing, noise, [&](double dt, const Truth::Sample& truth) {
    const double root = std::sqrt(dt);
    const double c = std::cos(drift), s = std::sin(drift);
    const Eigen::Vector2d d = scale * (truth.pose - last).head<2>();
    position += Eigen::Vector2d(c * d[0] - s * d[1] + noise.normal(errors.position_walk * root),
                                s * d[0] + c * d[1] + noise.normal(errors.position_walk * root));
    drift += noise.normal(errors.heading_walk * root);
    last = truth.pose;
    const double x = position[0] + noise.normal(errors.position_noise);
    const double y = position[1] + noise.normal(errors.position_noise);
    // A camera reports a yaw within one turn.
    return Eigen::Vector3d(x, y, wrapped_angle(truth.pose[2] + drift + noise.normal(errors.heading_noise)));
  });
}

std::vector<Measurement> synthetic_gyro(const Recording& recording, const GyroErrors& errors,
                                        const StreamTiming& timing, std::uint64_t seed) {
  check(timing);
  for (const auto& [name, value] : {std::pair("bias", errors.bias), std::pair("bias_walk", errors.bias_walk),
                                    std::pair("noise", errors.noise)})
    require(value >= 0, name, value, "a finite number >= 0");
  Random noise(seed);
  double bias = noise.normal(errors.bias);
  return stream(recording, timing, noise, [&](double dt, const Truth::Sample& truth) {
    bias += noise.normal(errors.bias_walk * std::sqrt(dt));
    return Eigen::Vector3d(truth.rate + bias + noise.normal(errors.noise), 0, 0);
  });
}

}  // namespace odobench
