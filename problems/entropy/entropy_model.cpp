#include "problems/entropy/entropy_model.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace odobench {
namespace {

void require_positive(const char* name, double value) {
  if (!std::isfinite(value) || value <= 0)
    throw std::invalid_argument(fmt::format("{}: found {}, expected a finite number > 0", name, value));
}

}  // namespace

double alpha(const EntropyConstants& constants) {
  return std::atan2(constants.width, constants.length);
}

double degrees_per_metre(const EntropyConstants& constants) {
  return 180.0 / (constants.wheel_distance * std::numbers::pi);
}

void validate(const EntropyConstants& c) {
  if (c.samples < 3) throw std::invalid_argument(fmt::format("samples: found {}, expected >= 3", c.samples));
  require_positive("dt", c.dt);
  require_positive("length", c.length);
  require_positive("width", c.width);
  require_positive("wheel_distance", c.wheel_distance);
  require_positive("sigma_encoder", c.sigma_encoder);
  require_positive("sigma_acceleration", c.sigma_acceleration);
  require_positive("sigma_rotation", c.sigma_rotation);
  require_positive("step_acceleration", c.step_acceleration);
  require_positive("step_rotation", c.step_rotation);
}

void validate(const EntropyWindow& window) {
  validate(window.constants);
  if (window.samples.size() != static_cast<std::size_t>(window.constants.samples))
    throw std::invalid_argument(fmt::format("window '{}': found {} samples, expected {}", window.id,
                                            window.samples.size(), window.constants.samples));
  for (std::size_t n = 0; n < window.samples.size(); ++n) {
    const EntropySample& s = window.samples[n];
    bool finite = std::isfinite(s.ax) && std::isfinite(s.ay) && std::isfinite(s.rotation);
    for (std::size_t w = 0; w < 4; ++w)
      finite = finite && std::isfinite(s.wheel[w]) && std::isfinite(s.steering[w]);
    if (!finite)
      throw std::invalid_argument(
          fmt::format("window '{}', sample {}: found a value that is not finite, expected finite numbers",
                      window.id, n + 1));
  }
}

Eigen::VectorXd increments(const EntropyConstants& constants, const Eigen::Ref<const Eigen::VectorXd>& t) {
  const int accelerations = 2 * (constants.samples - 2);
  Eigen::VectorXd values = t;
  values.head(accelerations) *= constants.step_acceleration;
  values.tail(constants.samples - 1) *= constants.step_rotation;
  return values;
}

Predictor::Predictor(const EntropyConstants& constants)
    : sin_2alpha_(std::sin(2.0 * alpha(constants))),
      cos_2alpha_(std::cos(2.0 * alpha(constants))),
      degrees_per_metre_(degrees_per_metre(constants)) {}

EntropyPrediction Predictor::predict(double sx, double sy, double r) const {
  const double across = r * sin_2alpha_, along = r * cos_2alpha_;
  return {
      {sx, sx + across, sx, sx - across}, {sy + r, sy - along, sy - r, sy + along}, degrees_per_metre_ * r};
}

}  // namespace odobench
