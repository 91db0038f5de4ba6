#include "problems/calibration/classical/drives.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "base/angle.hpp"
#include "problems/calibration/wheeled_form.hpp"

namespace odobench::classical {
namespace {

using Eigen::Index;

constexpr double kTurning = kPi / 2;

}  // namespace

Eigen::Vector3d relative(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const double c = std::cos(from[2]), s = std::sin(from[2]), dx = to[0] - from[0], dy = to[1] - from[1];
  return {c * dx + s * dy, c * dy - s * dx, to[2] - from[2]};
}

Matrix unit_track_motions(const Matrix& angles, double right_by_track, double left_by_track) {
  Matrix motions = Matrix::Zero(3, angles.cols());
  motions.row(0) = 0.5 * (right_by_track * angles.row(0) + left_by_track * angles.row(1));
  motions.row(2) = right_by_track * angles.row(0) - left_by_track * angles.row(1);
  return motions;
}

double Drive::path() const {
  double length = 0;
  for (Index k = 1; k < odometry.cols(); ++k)
    length += (odometry.col(k) - odometry.col(k - 1)).head<2>().norm();
  return length;
}

Eigen::Vector2d Drive::extent() const {
  const Matrix& poses = referenced_everywhere() ? measured : odometry;
  return poses.topRows(2).rowwise().maxCoeff() - poses.topRows(2).rowwise().minCoeff();
}

Drives::Drives(const Robot& robot, const std::vector<Recording>& recordings, const Options& options)
    : robot_(robot.table), options_(options), nominal_(robot_.nominal()) {
  CalibrationOptions cuts;
  cuts.cost = CostKind::Segments;
  cuts.rule = options.rule;
  cuts.distance = options.distance;
  const WheeledForm form(robot_, recordings, cuts);
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    list_.push_back(read(recordings[i], form.signals(i), form.seconds(i)));
    Drive& drive = list_.back();
    std::size_t entry = 0;
    for (const std::size_t stamp : form.rows(i)) {
      while (drive.stamps[entry] < stamp) ++entry;
      drive.rows.push_back(entry);
    }
  }
}

Drive Drives::read(const Recording& recording, const Matrix& signals, const Vector& seconds) const {
  Drive drive;
  drive.id = recording.id;
  drive.signals = signals;
  drive.seconds = seconds;
  drive.odometry = odometry(drive, nominal_, options_.rule);
  drive.sense = drive.turned() > kTurning ? 1 : drive.turned() < -kTurning ? -1 : 0;

  const Reference& reference = recording.reference;
  const bool everywhere = reference.sample.empty(), at_start = everywhere || reference.sample[0] == 0;
  const Eigen::Vector3d start = at_start ? Eigen::Vector3d(reference.x[0], reference.y[0], reference.theta[0])
                                         : Eigen::Vector3d::Zero();
  const std::size_t added = at_start ? 0 : 1;
  drive.measured = Matrix::Zero(3, static_cast<Index>(reference.x.size() + added));
  if (!at_start) drive.stamps.push_back(0);
  for (std::size_t i = 0; i < reference.x.size(); ++i) {
    drive.stamps.push_back(everywhere ? i : reference.sample[i]);
    Eigen::Vector3d pose = relative(start, {reference.x[i], reference.y[i], reference.theta[i]});
    const double reckoned = drive.odometry(2, static_cast<Index>(drive.stamps.back()));
    if (!everywhere) pose[2] = reckoned + wrapped_angle(pose[2] - reckoned);
    drive.measured.col(static_cast<Index>(i + added)) = pose;
  }
  return drive;
}

std::vector<const Drive*> Drives::of_sense(int sense) const {
  std::vector<const Drive*> found;
  for (const Drive& drive : list_)
    if (drive.sense == sense) found.push_back(&drive);
  return found;
}

Index Drives::position(const std::string& parameter) const {
  for (std::size_t i = 0; i < robot_.parameters().size(); ++i)
    if (robot_.parameters()[i].name == parameter) return static_cast<Index>(i);
  throw std::invalid_argument(fmt::format("the robot has no parameter '{}' of its own", parameter));
}

Matrix Drives::odometry(const Drive& drive, const Vector& z, robots::IntegrationRule rule) const {
  Matrix motions(3, drive.signals.cols()), poses(3, drive.signals.cols() + 1);
  robot_.twists(drive.signals, z, motions);
  robots::integrate(rule, motions, Eigen::Vector3d::Zero(), poses, drive.seconds);
  return poses;
}

Eigen::Vector3d Drives::end_error(const Drive& drive, const Vector& z) const {
  const Matrix poses = odometry(drive, z, options_.rule);
  Eigen::Vector3d error = drive.end() - poses.col(static_cast<Index>(drive.stamps.back()));
  error[2] = wrapped_angle(error[2]);
  return error;
}

}  // namespace odobench::classical
