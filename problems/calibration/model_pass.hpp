// One pass of ModelForm over a recording; of its files only.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "problems/calibration/model_form.hpp"

namespace odobench {

// b seen from a, moved to where a is: poses x, y, heading.
inline Eigen::Vector3d composed(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const double c = std::cos(a[2]), s = std::sin(a[2]);
  return {a[0] + c * b[0] - s * b[1], a[1] + s * b[0] + c * b[1], a[2] + b[2]};
}

struct ModelForm::Point {
  bool usable = true;
  std::vector<kernel::ModelWheel> wheels;
  std::vector<double> gains;
  Eigen::Vector2d lever = Eigen::Vector2d::Zero();
  double yaw = 0, time_offset = 0, factor = 1;
};

struct ModelForm::Pass {
  int width = 0;
  Eigen::Index intervals = 0;
  std::vector<double> own_data, walk, errors;
  kernel::ModelTask task;
  std::vector<Eigen::Vector3d> lanes;  // (c, alpha) where each begins
  // After find_errors(): start in use, angle of the frame there, and over the rows of each lane (in its own
  // frame, p: tracked place): n, sum p, sum |p|^2, sum e, sum Q p . e, sum e_theta, sum e . p.
  Eigen::Vector3d start = Eigen::Vector3d::Zero();
  double frame = 0;
  double squares = 0;  // with headings' weight relative to positions'
  struct Sums {
    double n = 0, px = 0, py = 0, pp = 0, ex = 0, ey = 0, qpe = 0, et = 0, pe = 0;
  };
  std::vector<Sums> sums;

  double at(Eigen::Index step, int entry, int lane) const {
    return walk[static_cast<std::size_t>((step * kernel::kWalk + entry) * width + lane)];
  }
  Eigen::Vector3d end(int lane) const {
    const Eigen::Index last = task.steps - 1;
    return {at(last, kernel::kX, lane), at(last, kernel::kY, lane), at(last, kernel::kHeadingSum, lane)};
  }
  bool turns_little() const {
    double most = 0;
    for (Eigen::Index s = 0; s < task.steps; ++s)
      for (int lane = 0; lane < width; ++lane) {
        const double turn = std::abs(at(s, kernel::kTurn, lane));
        if (!(turn <= most)) most = turn;
      }
    return most < kernel::kMaxAngle;
  }
  double travelled(Eigen::Index k) const {
    const Eigen::Index step = k % task.steps;
    const int lane = static_cast<int>(k / task.steps);
    return std::hypot(at(step, kernel::kUx, lane), at(step, kernel::kUy, lane));
  }
  // Place of the tracked frame after interval k, in the frame of the lane.
  Eigen::Vector2d in_lane(Eigen::Index step, int lane, const Eigen::Vector2d& lever) const {
    const double c = at(step, kernel::kCos, lane), s = at(step, kernel::kSin, lane);
    return {at(step, kernel::kX, lane) + c * lever[0] - s * lever[1],
            at(step, kernel::kY, lane) + s * lever[0] + c * lever[1]};
  }
  // c + (R(alpha) - I) l and alpha after interval k.
  Eigen::Vector3d tracked(Eigen::Index k, const Eigen::Vector2d& lever) const {
    const Eigen::Index step = k % task.steps;
    const int lane = static_cast<int>(k / task.steps);
    const Eigen::Vector3d& from = lanes[static_cast<std::size_t>(lane)];
    const Eigen::Vector2d p = in_lane(step, lane, lever);
    Eigen::Vector3d pose = composed(from, {p[0], p[1], at(step, kernel::kHeadingSum, lane)});
    pose.head<2>() -= lever;
    return pose;
  }
};

}  // namespace odobench
