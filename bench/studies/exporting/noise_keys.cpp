#include "bench/studies/exporting/noise_keys.hpp"

#include <fmt/format.h>

#include <cmath>

#include "problems/trust/odometry_noise.hpp"

namespace odobench {
namespace {

// Noise, or with what repeats; the upper bound where a variance came out as 0.
NoiseModel cautious_model(const NoiseFigures& figures, bool total, std::string& replaced) {
  NoiseModel model;
  for (int t = 0; t < kNoiseTerms; ++t) {
    const NoiseTermFigures* term = figures.find(noise_terms()[t].name);
    if (term == nullptr) continue;
    model.value[t] = total ? term->total : term->value;
    if (t >= kCapturePosition || model.value[t] > 0) continue;
    model.value[t] = term->upper;
    replaced += fmt::format("{}{}", replaced.empty() ? "" : ", ", term->name);
  }
  return model;
}

std::string diagonal(double x, double y, double yaw) {
  return fmt::format("[{:.3e}, {:.3e}, 0.0, 0.0, 0.0, {:.3e}]", x, y, yaw);
}

// Of one metre straight ahead and then one radian on the spot.
Eigen::Matrix3d pose_noise(const NoiseModel& model) {
  PoseTrack track;
  for (int k = 0; k <= 50; ++k) {
    track.x.push_back(0.02 * k);
    track.y.push_back(0);
    track.theta.push_back(0);
  }
  for (int k = 1; k <= 50; ++k) {
    track.x.push_back(1);
    track.y.push_back(0);
    track.theta.push_back(0.02 * k);
  }
  return propagated_noise(model, track);
}

bool omnidirectional(const std::string& kinematics) {
  return kinematics == "mecanum" || kinematics.starts_with("omni") || kinematics.starts_with("swerve") ||
         kinematics == "4wis4wid";
}

void add_origin(const NoiseFigures& f, KeyTable& table) {
  const auto v = [&](const char* name) { return f.value(name); };
  table.statements.push_back(fmt::format(
      "noise of the odometry, of {:.0f} drives: along {:.3g}, across {:.3g} m^2/m, heading {:.3g} rad^2/m; "
      "turning {:.3g}, {:.3g} m^2/rad, {:.3g} rad^2/rad",
      f.drives, v("along_per_metre"), v("across_per_metre"), v("heading_per_metre"), v("forward_per_radian"),
      v("sideways_per_radian"), v("heading_per_radian")));
  if (f.checked > 0)
    table.statements.push_back(
        fmt::format("left-out drives: NEES {:.2f}, 3 expected, 95 % band {:.2f} .. {:.2f}{}", f.nees,
                    f.nees_lower, f.nees_upper, f.consistent() ? "" : ": do not rely on these variances"));
  if (f.find("heading_per_radian") == nullptr)
    table.losses.push_back("the drives do not tell the noise of turning: the variances are those of driving");
  if (f.find("heading_per_metre") == nullptr)
    table.losses.push_back("the drives do not tell the noise of driving: the variances are those of turning");
}

}  // namespace

void add_noise_keys(const ParameterFile& file, bool keys, KeyTable& table) {
  if (!file.noise) return;
  const NoiseFigures& f = *file.noise;
  std::string replaced;
  const NoiseModel model = cautious_model(f, true, replaced);
  std::string not_said;
  const NoiseModel alone = cautious_model(f, false, not_said);
  add_origin(f, table);
  if (!replaced.empty())
    table.statements.push_back("too small to be measured, taken at the upper end of the interval: " +
                               replaced);
  const Eigen::Matrix3d white = twist_covariance(alone, f.speed, 0, f.turn_rate, kPublishPeriod);
  const Eigen::Matrix3d twist = twist_covariance(model, f.speed, 0, f.turn_rate, kPublishPeriod);
  const Eigen::Matrix3d pose = pose_noise(model);
  const std::string twist_text = diagonal(twist(0, 0), twist(1, 1), twist(2, 2));
  const std::string pose_text = diagonal(pose(0, 0), pose(1, 1), pose(2, 2));
  table.statements.push_back(
      fmt::format("twist variance = (|v| per metre + |w| per radian) / period, here v {:.3g} m/s, w {:.3g} "
                  "rad/s as in the "
                  "drives, period {:.3g} s (publish_rate {:.0f}): scale it with your own",
                  f.speed, f.turn_rate, kPublishPeriod, 1 / kPublishPeriod));
  table.statements.push_back(fmt::format(
      "they contain what repeats in every repetition, which a filter has no state for; noise alone: {}",
      diagonal(white(0, 0), white(1, 1), white(2, 2))));
  table.statements.push_back(
      "robot_localization: fuse vx, vy, vyaw of the odometry's twist with this covariance, not its pose, "
      "whose "
      "error grows without end; z, roll, pitch: two_d_mode");
  const std::array<double, 5> alpha =
      amcl_alphas(model, omnidirectional(file.kinematics), kAmclDistance, kAmclAngle);
  table.statements.push_back(
      fmt::format("amcl, {} model, update_min_d {} m, update_min_a {} rad: alpha1: {:.3e}, alpha2: {:.3e}, "
                  "alpha3: {:.3e}, "
                  "alpha4: {:.3e}, alpha5: {:.3e}",
                  omnidirectional(file.kinematics) ? "omnidirectional" : "differential", kAmclDistance,
                  kAmclAngle, alpha[0], alpha[1], alpha[2], alpha[3], alpha[4]));
  table.statements.push_back(
      "amcl's variances go with the square of an update's motion, these with the motion: alpha = variance "
      "per "
      "metre (radian) / update; amcl needs more where the map is not exact");
  if (!keys) {
    table.statements.push_back("twist covariance, x y z roll pitch yaw: " + twist_text);
    return;
  }
  table.keys.push_back({"pose_covariance_diagonal", pose_text, "after 1 m and 1 rad; it grows with the way"});
  table.keys.push_back({"twist_covariance_diagonal", twist_text, "see above"});
}

void add_noise_terms(const ParameterFile& file, KeyTable& table) {
  if (!file.noise) return;
  for (const NoiseTermFigures& t : file.noise->terms)
    table.keys.push_back({"noise." + t.name, fmt::format("{:.3e}", t.value),
                          fmt::format("{}, 95 % {:.3e} .. {:.3e}", t.unit, t.lower, t.upper)});
}

}  // namespace odobench
