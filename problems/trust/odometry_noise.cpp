#include "problems/trust/odometry_noise.hpp"

#include <cmath>
#include <stdexcept>

#include "problems/trust/noise_segments.hpp"

namespace odobench {
namespace {

Eigen::Matrix3d with_covariances(double first, double second, double heading, double one, double other) {
  Eigen::Matrix3d q;
  q << first, 0, one, 0, second, other, one, other, heading;
  return q;
}

}  // namespace

const std::array<NoiseTermInfo, kNoiseTerms>& noise_terms() {
  static const std::array<NoiseTermInfo, kNoiseTerms> list{{
      {"along_per_metre", "m^2/m", "along the travel, per metre"},
      {"across_per_metre", "m^2/m", "across the travel, per metre"},
      {"heading_per_metre", "rad^2/m", "heading, per metre"},
      {"forward_per_radian", "m^2/rad", "along the body, per radian"},
      {"sideways_per_radian", "m^2/rad", "across the body, per radian"},
      {"heading_per_radian", "rad^2/rad", "heading, per radian"},
      {"capture_position", "m^2", "position of the reference"},
      {"capture_heading", "rad^2", "heading of the reference"},
      {"capture_stamp", "s^2", "stamps of the reference"},
      {"along_heading_per_metre", "m rad/m", "along with heading, per metre"},
      {"across_heading_per_metre", "m rad/m", "across with heading, per metre"},
      {"forward_heading_per_radian", "m rad/rad", "forward with heading, per radian"},
      {"sideways_heading_per_radian", "m rad/rad", "sideways with heading, per radian"},
  }};
  return list;
}

Eigen::Matrix3d NoiseModel::per_metre() const {
  return with_covariances(value[kAlong], value[kAcross], value[kHeading], value[kAlongHeading],
                          value[kAcrossHeading]);
}

Eigen::Matrix3d NoiseModel::per_radian() const {
  return with_covariances(value[kForward], value[kSideways], value[kTurn], value[kForwardTurn],
                          value[kSidewaysTurn]);
}

Eigen::Matrix3d NoiseModel::increment(double dx, double dy, double dphi) const {
  const double ds = std::hypot(dx, dy);
  Eigen::Matrix3d q = std::abs(dphi) * per_radian();
  if (!(ds > 0)) return q;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() << dx / ds, -dy / ds, dy / ds, dx / ds;
  return q + ds * turn * per_metre() * turn.transpose();
}

std::vector<NoiseDrive> noise_drives(const CalibrationProblem& problem, const ConstVectorRef& z) {
  Eigen::Vector3d mount = Eigen::Vector3d::Zero();
  if (problem.options().mount) mount = z.tail<3>();
  // The body's pose behind a tracked one.
  const auto body = [&](PoseTrack track) {
    for (std::size_t k = 0; k < track.x.size(); ++k) {
      const double theta = track.theta[k] - mount[2];
      track.x[k] -= std::cos(theta) * mount[0] - std::sin(theta) * mount[1];
      track.y[k] -= std::sin(theta) * mount[0] + std::cos(theta) * mount[1];
      track.theta[k] = theta;
    }
    return track;
  };
  std::vector<NoiseDrive> drives;
  for (std::size_t n = 0; n < problem.recordings().size(); ++n) {
    const Recording& recording = problem.recordings()[n];
    NoiseDrive drive{recording.id,
                     recording.trajectory,
                     {},
                     body(problem.integrate(n, z)),
                     recording.reference.sample,
                     {}};
    for (const std::int64_t t : recording.time_us) drive.time_s.push_back(static_cast<double>(t) * 1e-6);
    if (drive.rows.empty())
      for (std::size_t k = 0; k < recording.reference.x.size(); ++k) drive.rows.push_back(k);
    drive.reference = body({recording.reference.x, recording.reference.y, recording.reference.theta});
    drives.push_back(std::move(drive));
  }
  return drives;
}

NoiseModel believable(const NoiseFit& fit) {
  NoiseModel model = fit.model;
  for (int t = 0; t < kCapturePosition; ++t)
    if (model.value[t] == 0) model.value[t] = fit.terms[static_cast<std::size_t>(t)].upper;
  model.value[kCapturePosition] = model.value[kCaptureHeading] = model.value[kCaptureStamp] = 0;
  return model;
}

Eigen::Matrix3d propagated_noise(const NoiseModel& model, const PoseTrack& poses) {
  const std::size_t n = poses.x.size();
  NoiseDrive drive;
  drive.odometry = drive.reference = poses;
  drive.time_s.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    drive.rows.push_back(k);
    drive.time_s[k] = static_cast<double>(k);
  }
  const noise::Path path = noise::path_of(drive);
  if (path.node.size() < 2) return Eigen::Matrix3d::Zero();
  NoiseModel own = model;
  own.value[kCapturePosition] = own.value[kCaptureHeading] = own.value[kCaptureStamp] = 0;
  return noise::covariance_of(own, noise::segment_between(drive, path, 0, path.node.size() - 1));
}

Eigen::Matrix3d twist_covariance(const NoiseModel& model, double vx, double vy, double omega,
                                 double period_s) {
  if (!(period_s > 0)) throw std::invalid_argument("twist_covariance: the period must be positive");
  return model.increment(vx * period_s, vy * period_s, omega * period_s) / (period_s * period_s);
}

std::array<double, 5> amcl_alphas(const NoiseModel& model, bool omnidirectional, double distance,
                                  double angle) {
  if (!(distance > 0) || !(angle > 0))
    throw std::invalid_argument("amcl_alphas: the motion of an update must be positive");
  const auto& v = model.value;
  const double by_turning = (v[kForward] + v[kSideways]) / 2;
  if (omnidirectional)
    return {by_turning / angle, v[kHeading] / distance, v[kAlong] / distance, v[kTurn] / angle,
            v[kAcross] / distance};
  return {v[kTurn] / angle, v[kHeading] / (2 * distance), v[kAlong] / distance, by_turning / angle,
          v[kAcross] / distance};
}

}  // namespace odobench
