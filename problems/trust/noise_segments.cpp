#include "problems/trust/noise_segments.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"

namespace odobench::noise {
namespace {

constexpr double kStep = 0.02;  // m, rad

Eigen::Vector2d position(const PoseTrack& track, std::size_t k) {
  return {track.x[k], track.y[k]};
}

Eigen::Vector2d turned(const Eigen::Vector2d& v, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * v[0] - s * v[1], s * v[0] + c * v[1]};
}

// (dx, dy, dtheta) from pose i to pose j in the frame of i.
Eigen::Vector3d relative(const PoseTrack& track, std::size_t i, std::size_t j) {
  const Eigen::Vector2d d = turned(position(track, j) - position(track, i), -track.theta[i]);
  return {d[0], d[1], track.theta[j] - track.theta[i]};
}

// What an error of the heading at a place does at the end, `lever` from it.
Eigen::Vector3d by_heading(const Eigen::Vector2d& lever) {
  return {-lever[1], lever[0], 1};
}

void add_square(double factor, const Eigen::Vector3d& v, Eigen::Matrix3d& to) {
  to.noalias() += factor * v * v.transpose();
}
void add_pair(double factor, const Eigen::Vector3d& v, const Eigen::Vector3d& w, Eigen::Matrix3d& to) {
  to.noalias() += factor * (v * w.transpose() + w * v.transpose());
}

// Body velocity round a node, in the frame of heading `theta0`.
Eigen::Vector3d velocity(const NoiseDrive& drive, const Path& path, std::size_t at, double theta0) {
  const std::size_t a = path.node[at > 0 ? at - 1 : at],
                    b = path.node[at + 1 < path.node.size() ? at + 1 : at];
  const double seconds = drive.time_s[b] - drive.time_s[a];
  if (!(seconds > 0)) return Eigen::Vector3d::Zero();
  const Eigen::Vector2d d =
      turned(position(drive.odometry, b) - position(drive.odometry, a), -theta0) / seconds;
  return {d[0], d[1], (drive.odometry.theta[b] - drive.odometry.theta[a]) / seconds};
}

// The terms of one step of the odometry, poses a and b; start and end of the motion are i and j.
void add_step(const PoseTrack& q, std::size_t i, std::size_t a, std::size_t b, std::size_t j,
              std::array<Eigen::Matrix3d, kNoiseTerms>& basis) {
  const double theta0 = q.theta[i];
  const Eigen::Vector2d way = turned(position(q, b) - position(q, a), -theta0);
  const double ds = way.norm(), dphi = std::abs(q.theta[b] - q.theta[a]);
  const Eigen::Vector2d middle = (position(q, a) + position(q, b)) / 2;
  const Eigen::Vector3d heading = by_heading(turned(position(q, j) - middle, -theta0));
  const Eigen::Vector2d t = ds > 0 ? Eigen::Vector2d(way / ds) : Eigen::Vector2d(1, 0);
  const Eigen::Vector3d along(t[0], t[1], 0), across(-t[1], t[0], 0);
  add_square(ds, along, basis[kAlong]);
  add_square(ds, across, basis[kAcross]);
  add_square(ds, heading, basis[kHeading]);
  add_pair(ds, along, heading, basis[kAlongHeading]);
  add_pair(ds, across, heading, basis[kAcrossHeading]);
  const double yaw = (q.theta[a] + q.theta[b]) / 2 - theta0;
  const Eigen::Vector3d forward(std::cos(yaw), std::sin(yaw), 0), sideways(-forward[1], forward[0], 0);
  add_square(dphi, forward, basis[kForward]);
  add_square(dphi, sideways, basis[kSideways]);
  add_square(dphi, heading, basis[kTurn]);
  add_pair(dphi, forward, heading, basis[kForwardTurn]);
  add_pair(dphi, sideways, heading, basis[kSidewaysTurn]);
}

std::size_t nearest_node(const Path& path, double progress) {
  std::size_t best = kNone;
  double distance = 0;
  for (std::size_t k = 0; k < path.node.size(); ++k) {
    if (path.reference[k] == kNone) continue;
    const double d = std::abs(path.progress[k] - progress);
    if (best == kNone || d < distance) best = k, distance = d;
  }
  return best;
}

}  // namespace

Path path_of(const NoiseDrive& drive) {
  Path path;
  if (drive.rows.size() < 2) return path;
  const PoseTrack& q = drive.odometry;
  const bool everywhere = drive.rows.size() == drive.time_s.size();
  const std::size_t begin = drive.rows.front(), end = drive.rows.back();
  std::size_t row = 0;
  for (std::size_t k = begin; k <= end; ++k) {
    while (row + 1 < drive.rows.size() && drive.rows[row] < k) ++row;
    const bool measured = drive.rows[row] == k;
    const bool forced = k == begin || k == end || (measured && !everywhere);
    double way = 0, turn = 0;
    if (!path.node.empty()) {
      const std::size_t last = path.node.back();
      way = (position(q, k) - position(q, last)).norm();
      turn = std::abs(q.theta[k] - q.theta[last]);
    }
    if (!forced && way < kStep && turn < kStep) continue;
    path.metres += way;
    path.radians += turn;
    path.node.push_back(k);
    path.reference.push_back(measured ? row : kNone);
    path.progress.push_back(path.metres + path.radians);
  }
  return path;
}

Segment segment_between(const NoiseDrive& drive, const Path& path, std::size_t first, std::size_t last) {
  Segment out;
  for (Eigen::Matrix3d& b : out.basis) b.setZero();
  const PoseTrack& q = drive.odometry;
  const std::size_t i = path.node[first], j = path.node[last];
  for (std::size_t k = first; k < last; ++k) {
    const std::size_t a = path.node[k], b = path.node[k + 1];
    add_step(q, i, a, b, j, out.basis);
    out.metres += (position(q, b) - position(q, a)).norm();
    out.radians += std::abs(q.theta[b] - q.theta[a]);
  }
  out.motion = relative(q, i, j);
  out.error = out.motion - relative(drive.reference, path.reference[first], path.reference[last]);
  out.error[2] = wrapped_angle(out.error[2]);
  const Eigen::Vector3d start = by_heading(out.motion.head<2>());
  out.basis[kCapturePosition].diagonal() << 2, 2, 0;
  add_square(1, start, out.basis[kCaptureHeading]);
  out.basis[kCaptureHeading](2, 2) += 1;
  const Eigen::Vector3d before = velocity(drive, path, first, q.theta[i]),
                        after = velocity(drive, path, last, q.theta[i]);
  add_square(1, Eigen::Vector3d(before[0], before[1], 0) + before[2] * start, out.basis[kCaptureStamp]);
  add_square(1, after, out.basis[kCaptureStamp]);
  return out;
}

std::vector<Segment> cut(const NoiseDrive& drive, const Path& path, int parts) {
  std::vector<Segment> out;
  std::size_t first = 0;
  for (int k = 1; k <= parts; ++k) {
    const std::size_t last = nearest_node(path, path.progress.back() * k / parts);
    if (last == kNone || last <= first) continue;
    out.push_back(segment_between(drive, path, first, last));
    out.back().index = k - 1;
    first = last;
  }
  return out;
}

Eigen::Matrix3d covariance_of(const NoiseModel& model, const Segment& segment) {
  Eigen::Matrix3d p = Eigen::Matrix3d::Zero();
  for (int m = 0; m < kNoiseTerms; ++m)
    if (model.value[m] != 0) p += model.value[m] * segment.basis[m];
  return p;
}

TypicalMotion typical_motion(const std::vector<NoiseDrive>& drives, const std::vector<Path>& paths) {
  double metres = 0, travelling = 0, radians = 0, turning = 0;
  for (std::size_t n = 0; n < drives.size(); ++n)
    for (std::size_t k = 0; k + 1 < paths[n].node.size(); ++k) {
      const std::size_t a = paths[n].node[k], b = paths[n].node[k + 1];
      const PoseTrack& q = drives[n].odometry;
      const double ds = (position(q, b) - position(q, a)).norm(), dphi = std::abs(q.theta[b] - q.theta[a]);
      const double seconds = drives[n].time_s[b] - drives[n].time_s[a];
      if (ds >= kStep / 4) metres += ds, travelling += seconds;
      if (dphi >= kStep / 4) radians += dphi, turning += seconds;
    }
  return {travelling > 0 ? metres / travelling : 0, turning > 0 ? radians / turning : 0};
}

}  // namespace odobench::noise
