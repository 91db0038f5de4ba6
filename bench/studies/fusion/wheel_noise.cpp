#include "bench/studies/fusion/wheel_noise.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/angle.hpp"
#include "base/error.hpp"
#include "base/text.hpp"
#include "bench/catalogue/number_text.hpp"
#include "bench/catalogue/option_values.hpp"

namespace odobench {
namespace {

constexpr double kLargestSigma = 1e6;

// Median step of the recordings' stamps.
double usual_period(const std::vector<Recording>& recordings) {
  std::vector<double> steps;
  for (const Recording& r : recordings)
    for (std::size_t k = 1; k < r.size(); ++k)
      steps.push_back(static_cast<double>(r.time_us[k] - r.time_us[k - 1]) * 1e-6);
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

}  // namespace

WheelNoiseChoice wheel_noise_choice(const std::string& text, const SensorsFile& sensors) {
  using Kind = WheelNoiseChoice::Kind;
  if (text.empty()) return {sensors.wheels ? Kind::File : Kind::Total};
  if (text == "measured") return {Kind::Measured};
  if (text == "total") return {Kind::Total};
  if (text == "file") {
    if (!sensors.wheels)
      throw DataError(
          "--odometry-noise=file: the sensors' file has no \"wheels\", expected sigma_velocity and "
          "sigma_yaw_rate there");
    return {Kind::File};
  }
  const std::vector<std::string> parts = comma_items(text);
  if (parts.size() != 2)
    throw std::invalid_argument(fmt::format(
        "--odometry-noise={}: expected measured, total, file, or two standard deviations V,W of a "
        "sample in m/s and rad/s",
        shown(text)));
  return {Kind::Values, finite_number("--odometry-noise", parts[0], true, kLargestSigma),
          finite_number("--odometry-noise", parts[1], true, kLargestSigma)};
}

std::string believe_wheels(const WheelNoiseChoice& choice, const LoadedProblem& loaded, const Vector& z,
                           const std::string& label, SensorsFile& sensors) {
  using Kind = WheelNoiseChoice::Kind;
  FusionOptions& o = sensors.options;
  if (choice.kind == Kind::Values) {
    o.sigma_velocity = choice.velocity;
    o.sigma_yaw_rate = choice.yaw_rate;
  }
  if (choice.kind == Kind::File || choice.kind == Kind::Values)
    return fmt::format("Wheels in the filter: σ {:g} m/s and {:g} rad/s of a sample.", o.sigma_velocity,
                       o.sigma_yaw_rate);
  NoiseOptions how;
  how.check = false;
  how.with_bias = choice.kind == Kind::Total;
  const NoiseFit fit = fit_odometry_noise(noise_drives(*loaded.calibration, z), how);
  if (!fit.refused.empty())
    throw DataError(
        fmt::format("--odometry-noise: the noise of the odometry cannot be measured: {}; give "
                    "--odometry-noise=V,W or \"wheels\" in the sensors' file",
                    fit.refused));
  const NoiseModel model = believable(fit);
  const Eigen::Matrix3d q = twist_covariance(model, fit.typical.speed, 0, fit.typical.turn_rate,
                                             usual_period(loaded.calibration->recordings()));
  o.sigma_velocity = std::max(kLeastWheelSigma, std::sqrt((q(0, 0) + q(1, 1)) / 2));
  o.sigma_yaw_rate = std::max(kLeastWheelSigma, std::sqrt(q(2, 2)));
  o.wheel_noise = model;
  const auto root = [&](NoiseTerm term, double unit) {
    return unit * std::sqrt(model.value[static_cast<std::size_t>(term)]);
  };
  return fmt::format(
      "Wheels in the filter with {}: measured on these drives{}: {:.3g} mm along, {:.3g} mm across, {:.3g} "
      "deg "
      "after 1 m; {:.3g} mm, {:.3g} mm, {:.3g} deg after 1 rad (about σ {:.2g} m/s and {:.2g} rad/s of a "
      "sample).",
      label, choice.kind == Kind::Total ? ", with what repeats" : "", root(kAlong, 1000), root(kAcross, 1000),
      root(kHeading, 1 / kDegree), root(kForward, 1000), root(kSideways, 1000), root(kTurn, 1 / kDegree),
      o.sigma_velocity, o.sigma_yaw_rate);
}

}  // namespace odobench
