#include "problems/simulation/robot_drives.hpp"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/angle.hpp"

namespace odobench {
namespace {

constexpr double kSpeed = 0.25;         // m/s
constexpr double kTurn = 0.5;           // rad/s, on the spot
constexpr double kSpeedUp = 0.4;        // s, to full speed and back
constexpr double kSide = 1.5;           // m
constexpr double kSteeringLimit = 0.6;  // rad, of robots that steer like cars
constexpr int kStanding = 10;           // intervals before and after
// Directions that wheels forbid by less than this are what rounding and calibration leave.
constexpr double kForbidden = 1e-9;

bool can_do(const robots::WheeledRobot& model, const Vector& z, const Eigen::Vector3d& twist) {
  try {
    const Vector signals = model.inverse(twist, z);
    for (Eigen::Index i = model.drive_count(); i < signals.size(); ++i)
      if (!std::isfinite(signals[i])) return false;
    return true;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

// Front wheels of cars turn by at most kSteeringLimit; others steer as they like.
double least_radius(const RobotAbilities& can, const robots::WheeledRobot& model, const Vector& z) {
  double radius = 0.1;
  for (; radius < 100; radius *= 1.05) {
    const Vector signals = model.inverse(kSpeed * can.ahead + kSpeed / radius * can.turn, z);
    bool reachable = true;
    for (Eigen::Index i = model.drive_count(); i < signals.size(); ++i)
      reachable = reachable && std::abs(signals[i]) <= kSteeringLimit;
    if (reachable) break;
  }
  return radius;
}

// Wheels that neither steer nor slide allow a plane of twists, or all.
void set_directions(const Robot& robot, const robots::WheeledRobot& model, const Vector& z,
                    RobotAbilities& can) {
  const robots::WheelRows rows =
      model.rows(Matrix::Zero(static_cast<Eigen::Index>(model.signals().size()), 1), z);
  Matrix held(0, 3);
  for (std::size_t w = 0; w < robot.table.wheels.size(); ++w) {
    const Wheel& wheel = robot.table.wheels[w];
    if (!wheel.steering.empty() || wheel.slides) continue;
    for (std::size_t i = 0; i < rows.names.size(); ++i) {
      if (rows.names[i] != fmt::format("wheel {} side", w + 1)) continue;
      held.conservativeResize(held.rows() + 1, 3);
      held.row(held.rows() - 1) = rows.a.row(static_cast<Eigen::Index>(i));
    }
  }
  if (held.rows() == 0) return;
  const Eigen::JacobiSVD<Matrix> svd(held, Eigen::ComputeFullV);
  const auto count = svd.singularValues().size();
  Eigen::Index rank = 0;
  while (rank < count && svd.singularValues()[rank] > kForbidden * svd.singularValues()[0]) ++rank;
  const Eigen::Vector3d normal = svd.matrixV().col(0);
  const double across = std::hypot(normal[0], normal[1]);
  if (rank > 1 || across < kForbidden)
    throw std::invalid_argument("its wheels that neither steer nor slide hold each other: no drive turns");
  can.ahead = {normal[1] / across, -normal[0] / across, 0};
  if (can.ahead[0] < 0 || (can.ahead[0] == 0 && can.ahead[1] < 0)) can.ahead = -can.ahead;
  const double drift = -normal[2] / (across * across);
  can.turn = {drift * normal[0], drift * normal[1], 1};
}

RobotPhase ahead(double length) {
  return {kSpeed, 0, 0, length / kSpeed};
}
RobotPhase corner(const RobotAbilities& a, double sense) {
  if (a.on_the_spot && a.least_radius == 0) return {0, 0, sense * kTurn, kPi / 2 / kTurn};
  const double radius = std::max(a.least_radius, 0.4), omega = kSpeed / radius;
  return {kSpeed, 0, sense * omega, kPi / 2 / omega};
}
RobotPhase circle(const RobotAbilities& a, double sense, double factor = 1) {
  const double radius = factor * std::max(1.3 * a.least_radius, 0.6), omega = kSpeed / radius;
  return {kSpeed, 0, sense * omega, 2 * kPi / omega};
}

// Share of the commanded speed t seconds into a phase that lasts so much longer that its length stays.
double ramp(double t, double seconds) {
  const double all = seconds + kSpeedUp;
  return std::clamp(std::min(t, all - t) / kSpeedUp, 0.0, 1.0);
}

}  // namespace

RobotAbilities abilities_of(const Robot& robot, const robots::WheeledRobot& model, const Vector& z) {
  RobotAbilities a;
  const bool own = robot.kinematics == kOwnWheels;
  if (own) set_directions(robot, model, z, a);
  a.sideways = can_do(model, z, {-kSpeed * a.ahead[1], kSpeed * a.ahead[0], 0});
  a.on_the_spot = can_do(model, z, kTurn * a.turn);
  const bool steered = static_cast<Eigen::Index>(model.signals().size()) > model.drive_count();
  if (robot.kinematics == "bicycle" || robot.kinematics == "ackermann" || (own && steered && !a.sideways))
    a.least_radius = least_radius(a, model, z);
  return a;
}

std::vector<RobotDrive> standard_drives(const RobotAbilities& a) {
  std::vector<RobotDrive> drives;
  for (const double sense : {-1.0, 1.0}) {
    RobotDrive square{sense > 0 ? "square_ccw" : "square_cw",
                      fmt::format("square of {} m, {}", kSide, sense > 0 ? "counter-clockwise" : "clockwise"),
                      {}};
    for (int i = 0; i < 4; ++i) {
      square.phases.push_back(ahead(kSide));
      square.phases.push_back(corner(a, sense));
    }
    drives.push_back(std::move(square));
  }
  drives.push_back({"circle_cw", "a circle, clockwise", {circle(a, -1)}});
  drives.push_back({"circle_ccw", "a circle, counter-clockwise", {circle(a, 1)}});
  drives.push_back({"eight", "a circle in each sense", {circle(a, 1), circle(a, -1)}});
  drives.push_back({"line", "a straight line of 3 m", {ahead(3)}});
  if (a.sideways) drives.push_back({"sideways", "2 m to the left", {{0, kSpeed, 0, 2 / kSpeed}}});
  return drives;
}

std::vector<RobotDrive> known_drives(const RobotAbilities& a) {
  std::vector<RobotDrive> drives = standard_drives(a);
  drives.push_back({"line_back", "3 m backwards", {{-kSpeed, 0, 0, 3 / kSpeed}}});
  drives.push_back({"wide_cw", "a circle of twice the radius, clockwise", {circle(a, -1, 2)}});
  drives.push_back({"wide_ccw", "a circle of twice the radius, counter-clockwise", {circle(a, 1, 2)}});
  if (a.on_the_spot && a.least_radius == 0) {
    drives.push_back({"turn_cw", "two turns on the spot, clockwise", {{0, 0, -kTurn, 4 * kPi / kTurn}}});
    drives.push_back(
        {"turn_ccw", "two turns on the spot, counter-clockwise", {{0, 0, kTurn, 4 * kPi / kTurn}}});
  }
  if (!a.sideways) return drives;
  const double part = kSpeed / std::sqrt(2.0);
  drives.push_back({"diagonal_left", "2 m ahead and to the left", {{part, part, 0, 2 / kSpeed}}});
  drives.push_back({"diagonal_right", "2 m ahead and to the right", {{part, -part, 0, 2 / kSpeed}}});
  RobotPhase sliding = circle(a, 1);
  std::swap(sliding.vx, sliding.vy);
  drives.push_back({"sliding_ccw", "a circle moving to the left, counter-clockwise", {sliding}});
  return drives;
}

std::vector<RobotDrive> small_circles(const RobotAbilities& a) {
  std::vector<RobotDrive> drives;
  for (const double radius : {0.1, 0.2, 0.3, 0.5, 1.0}) {
    if (radius < a.least_radius) continue;
    for (const double sense : {-1.0, 1.0}) {
      const double omega = std::min(kSpeed / radius, kTurn);  // wheels go no faster than on the spot
      drives.push_back({fmt::format("circle_{:g}m_{}", radius, sense > 0 ? "ccw" : "cw"),
                        fmt::format("a circle of {:g} m radius, {}", radius,
                                    sense > 0 ? "counter-clockwise" : "clockwise"),
                        {{radius * omega, 0, sense * omega, 2 * kPi / omega}}});
    }
  }
  return drives;
}

Matrix twists_of(const RobotDrive& drive, const RobotAbilities& can) {
  std::vector<Eigen::Vector3d> list(kStanding, Eigen::Vector3d::Zero());
  const bool plain = can.ahead == Eigen::Vector3d(1, 0, 0) && can.turn == Eigen::Vector3d(0, 0, 1);
  const Eigen::Vector3d left(-can.ahead[1], can.ahead[0], 0);
  for (const RobotPhase& phase : drive.phases) {
    Eigen::Vector3d twist(phase.vx, phase.vy, phase.omega);
    if (!plain) twist = phase.vx * can.ahead + phase.vy * left + phase.omega * can.turn;
    for (double t = kRobotStep / 2; t < phase.seconds + kSpeedUp; t += kRobotStep)
      list.push_back(ramp(t, phase.seconds) * twist);
  }
  list.insert(list.end(), kStanding, Eigen::Vector3d::Zero());
  Matrix twists(3, static_cast<Eigen::Index>(list.size()));
  for (Eigen::Index k = 0; k < twists.cols(); ++k) twists.col(k) = list[static_cast<std::size_t>(k)];
  return twists;
}

}  // namespace odobench
