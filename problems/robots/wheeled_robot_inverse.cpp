// From a twist to the signals of wheels that roll without slip.
#include <fmt/format.h>

#include <Eigen/QR>
#include <cmath>
#include <stdexcept>

#include "base/angle.hpp"
#include "problems/robots/wheeled_robot_workspace.hpp"

namespace odobench::robots {
namespace {

constexpr double kStandstill = 1e-9;  // m/s of a pivot
constexpr double kImpossible = 1e-9;  // m/s sideways, relative to max(1, |twist|)

// Direction of rolling with n.u = 0 at the contact: with a trail d, sin(direction - phi) |u| = -d omega at
// the pivot's u. Of the two, the one that is turned less from the mount.
double rolling_direction(const WheelNumbers& w, double ux, double uy, double omega, std::size_t wheel) {
  const double sine = w.trail * omega / std::hypot(ux, uy);
  if (std::abs(sine) > 1)
    throw std::invalid_argument(fmt::format(
        "robot: wheel {} cannot roll: with a trail of {} m its contact always slides in this twist",
        wheel + 1, w.trail));
  const double ahead = wrapped_angle(std::atan2(uy, ux) + std::asin(sine) - w.mount);
  const double behind = wrapped_angle(std::atan2(uy, ux) - std::asin(sine) + kPi - w.mount);
  const double turned = std::abs(std::abs(ahead) - std::abs(behind)) < 1e-12 ? std::max(ahead, behind)
                        : std::abs(ahead) < std::abs(behind)                 ? ahead
                                                                             : behind;
  return w.mount + turned;
}

}  // namespace

Vector WheeledRobot::inverse(const Eigen::Vector3d& twist, const ConstVectorRef& z,
                             const Vector& held) const {
  const std::vector<WheelNumbers> wheels = numbers(z);
  const auto count = static_cast<Eigen::Index>(signals_.size());
  if (!twist.allFinite()) throw std::invalid_argument("robot: a twist that is not finite");
  if (held.size() != 0 && held.size() != count)
    throw std::invalid_argument(fmt::format("robot: {} signals held, expected {}", held.size(), count));
  Vector signals = held.size() ? held : Vector(Vector::Zero(count));
  std::vector<bool> set(signals_.size(), false);
  Matrix weights = Matrix::Zero(static_cast<Eigen::Index>(wheels.size()), drive_count_);
  Vector drives = Vector::Zero(weights.rows());
  for (std::size_t i = 0; i < wheels.size(); ++i) {
    const WheelNumbers& w = wheels[i];
    const Plan& plan = plans_[i];
    if (w.steered) {
      const double ux = twist[0] - twist[2] * w.y, uy = twist[1] + twist[2] * w.x;
      double& steering = signals[plan.steering];
      if (std::hypot(ux, uy) >= kStandstill) {
        if (w.gain == 0) throw std::invalid_argument(fmt::format("robot: wheel {}: steering gain 0", i + 1));
        const double angle = (rolling_direction(w, ux, uy, twist[2], i) - w.heading) / w.gain;
        const auto row = static_cast<std::size_t>(plan.steering);
        if (set[row] && std::abs(std::remainder(angle - steering, 2 * kPi)) > kImpossible)
          throw std::invalid_argument(
              fmt::format("robot: signal '{}' would have to steer wheels to {} and {} rad", signals_[row],
                          steering, angle));
        steering = angle;
        set[row] = true;
      }
    }
    const Contact c = contact(w, plan.steering >= 0 ? signals[plan.steering] : 0);
    const double aside = c.side_row().dot(twist);
    if (!plan.slides && std::abs(aside) > kImpossible * std::max(1.0, twist.norm()))
      throw std::invalid_argument(
          fmt::format("robot: wheel {} would have to move sideways by {:.6g} m/s", i + 1, aside));
    if (!plan.driven) continue;
    for (const auto& [row, weight] : plan.drives) weights(static_cast<Eigen::Index>(i), row) = weight;
    drives[static_cast<Eigen::Index>(i)] = c.drive_row().dot(twist) / w.radius;
  }
  // One encoder per wheel: its speed; the mean of two: both alike.
  signals.head(drive_count_) = weights.completeOrthogonalDecomposition().solve(drives);
  const Vector apart = weights * signals.head(drive_count_) - drives;
  if (apart.cwiseAbs().maxCoeff() > kImpossible * std::max(1.0, drives.norm()))
    throw std::invalid_argument(
        "robot: wheels that share a drive signal would have to turn at different speeds");
  return signals;
}

}  // namespace odobench::robots
