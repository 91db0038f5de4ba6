#include "problems/fusion/fusion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "problems/fusion/fusion_states.hpp"
#include "problems/fusion/robot_model.hpp"
#include "problems/kalman/triangular.hpp"

namespace odobench {
namespace {

void check_sensor(const SensorStream& s) {
  const auto positive = [&](const char* field, double value) {
    if (!(value > 0) || !std::isfinite(value))
      throw std::invalid_argument(
          fmt::format("sensor '{}': {} is {}, expected a finite number > 0", s.name, field, value));
  };
  if (s.kind == SensorKind::YawRate) {
    positive("sigma of the yaw rate", s.sigma_rate);
    positive("hold", s.hold_s);
    return;
  }
  if (s.kind != SensorKind::Heading) positive("sigma of the position", s.sigma_position);
  positive("sigma of the heading", s.sigma_heading);
}

void check_data(const SensorStream& s, const Recording& recording) {
  bool inside = false;
  for (std::size_t i = 0; i < s.data.size(); ++i) {
    const Measurement& m = s.data[i];
    if (i > 0 && m.time_us <= s.data[i - 1].time_us)
      throw std::runtime_error(
          fmt::format("sensor '{}': stamp {} us of measurement {} follows {} "
                      "us, expected increasing stamps",
                      s.name, m.time_us, i + 1, s.data[i - 1].time_us));
    if (m.arrival_us < m.time_us)
      throw std::runtime_error(
          fmt::format("sensor '{}': measurement {} of {} us arrives at {} us, "
                      "before its stamp",
                      s.name, i + 1, m.time_us, m.arrival_us));
    if (!m.value.allFinite())
      throw std::runtime_error(
          fmt::format("sensor '{}': measurement {} of {} us is not finite", s.name, i + 1, m.time_us));
    inside = inside || (m.time_us >= recording.time_us.front() && m.time_us <= recording.time_us.back());
  }
  if (!inside)
    throw std::runtime_error(fmt::format("sensor '{}' has no data in recording '{}'", s.name, recording.id));
}

}  // namespace

void validate(const FusionOptions& o, std::span<const SensorStream> sensors) {
  require(o.sigma_velocity > 0, "sigma of the wheels' velocity", o.sigma_velocity, "a finite number > 0");
  require(o.sigma_yaw_rate > 0, "sigma of the wheels' yaw rate", o.sigma_yaw_rate, "a finite number > 0");
  require(o.initial_position >= 0, "sigma of the initial position", o.initial_position,
          "a finite number >= 0");
  require(o.initial_heading >= 0, "sigma of the initial heading", o.initial_heading, "a finite number >= 0");
  for (const auto& [name, walk] :
       {std::pair("gyro bias", o.gyro_bias), std::pair("odometry scale", o.odometry_scale)})
    if (walk && (!(walk->initial >= 0) || !(walk->walk >= 0) || !std::isfinite(walk->initial + walk->walk)))
      throw std::invalid_argument(fmt::format("{}: initial {} and walk {}, expected finite numbers >= 0",
                                              name, walk->initial, walk->walk));
  require(o.gate_probability >= 0 && o.gate_probability < 1, "gate probability", o.gate_probability,
          "at least 0 and below 1");
  for (const Eigen::Index n : {3, 6, 8, 13})
    (void)sigma_weights(o.filter.unscented, n);  // the sizes that occur
  require(o.max_delay_s >= 0, "largest delay", o.max_delay_s, "a finite number >= 0");
  std::set<std::string> names;
  int gyros = 0, relatives = 0;
  for (const SensorStream& s : sensors) {
    check_sensor(s);
    if (!names.insert(s.name).second)
      throw std::invalid_argument(fmt::format("two sensors are called '{}'", s.name));
    gyros += s.kind == SensorKind::YawRate ? 1 : 0;
    relatives += s.kind == SensorKind::RelativePose ? 1 : 0;
  }
  if (gyros > 1) throw std::invalid_argument("two yaw-rate sensors, expected at most one");
  if (relatives > 1) throw std::invalid_argument("two sensors of relative poses, expected at most one");
  if (o.gyro_bias && gyros == 0)
    throw std::invalid_argument("a gyro bias is estimated but there is no yaw-rate sensor");
  if (o.smooth && relatives > 0)
    throw std::invalid_argument(
        "the smoother does not work with relative "
        "poses (their copied state is singular)");
}

FusionResult fuse(const Recording& recording, const ConstVectorRef& z, std::span<const SensorStream> sensors,
                  const FusionOptions& options, bool keep_innovations) {
  validate(options, sensors);
  if (recording.size() < 2)
    throw std::runtime_error(
        fmt::format("recording '{}' has {} samples, expected at least 2", recording.id, recording.size()));
  for (std::size_t k = 1; k < recording.size(); ++k)
    if (recording.time_us[k] <= recording.time_us[k - 1])
      throw std::runtime_error(
          fmt::format("recording '{}': stamp {} us of sample {} follows {} us, expected "
                      "increasing stamps",
                      recording.id, recording.time_us[k], k + 1, recording.time_us[k - 1]));
  for (const SensorStream& s : sensors) check_data(s, recording);
  const bool copy = std::any_of(sensors.begin(), sensors.end(),
                                [](const SensorStream& s) { return s.kind == SensorKind::RelativePose; });
  const bool augmented = copy || options.gyro_bias || options.odometry_scale;
  return (augmented ? fuse_augmented : fuse_plain)(recording, z, sensors, options, keep_innovations);
}

TrackErrors track_errors(const Recording& recording, const PoseTrack& track,
                         const std::vector<Eigen::Matrix3d>& factors) {
  TrackErrors out;
  out.max = {recording.id, recording.trajectory, recording.repetition};
  const std::size_t n = recording.size();
  const auto error = [&](std::size_t k) {
    return Eigen::Vector3d(track.x[k] - recording.reference.x[k], track.y[k] - recording.reference.y[k],
                           track.theta[k] - recording.reference.theta[k]);
  };
  double position = 0, heading = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const Eigen::Vector3d e = error(k);
    out.max.x = std::max(out.max.x, std::abs(e[0]));
    out.max.y = std::max(out.max.y, std::abs(e[1]));
    out.max.theta = std::max(out.max.theta, std::abs(e[2]));
    position += e.head<2>().squaredNorm();
    heading += e[2] * e[2];
  }
  out.rmse_position = std::sqrt(position / static_cast<double>(n));
  out.rmse_heading = std::sqrt(heading / static_cast<double>(n));
  if (factors.empty()) return out;
  for (std::size_t i = 1; i <= TrackErrors::kGrid; ++i) {
    const std::size_t k = (n - 1) * i / TrackErrors::kGrid;
    const Eigen::Vector3d e = error(k);
    out.nees.push_back(forward_solved<3, 1>(factors[k], e).squaredNorm());
    out.component_nees.push_back(e.cwiseAbs2().cwiseQuotient(factors[k].rowwise().squaredNorm()));
  }
  return out;
}

}  // namespace odobench
