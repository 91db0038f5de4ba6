#include "problems/simulation/robot_demo.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/angle.hpp"
#include "base/random.hpp"
#include "datasets/robots/layouts.hpp"
#include "problems/robots/integration.hpp"
#include "problems/robots/wheeled_robot.hpp"

namespace odobench {
namespace {

constexpr int kRepetitions = 3;
constexpr std::int64_t kStep_us = 50'000;
constexpr double kStep = 0.05;           // s
constexpr double kCounts = 4096;         // of a turn
constexpr double kPositionNoise = 2e-4;  // m
constexpr double kHeadingNoise = 5e-4;   // rad
constexpr double kSpeed = 0.25;          // m/s
constexpr double kTurn = 0.5;            // rad/s, on the spot
constexpr double kRamp = 0.4;            // s, to full speed and back
constexpr double kSide = 1.5;            // m
constexpr double kDriveWander = 0.03;    // of the speed
constexpr double kSteeringWander = 2 * kDegree;
constexpr double kSteeringLimit = 0.6;  // rad, of robots that steer like cars

// Constant commands for a while; speeds ramp up and down at their ends.
struct Phase {
  double vx, vy, omega, seconds;
};
struct DemoDrive {
  std::string name, description;
  std::vector<Phase> phases;
};

// What a class can do.
struct Abilities {
  bool on_the_spot = true, sideways = false;
  double least_radius = 0;  // m, of circles of the origin
};

Abilities abilities(const robots::WheeledRobot& robot, const Vector& z) {
  const auto can = [&](const Eigen::Vector3d& twist) {
    try {
      const Vector signals = robot.inverse(twist, z);
      for (Eigen::Index i = robot.drive_count(); i < signals.size(); ++i)
        if (!std::isfinite(signals[i])) return false;
      return true;
    } catch (const std::invalid_argument&) {
      return false;
    }
  };
  Abilities a;
  a.sideways = can({0, kSpeed, 0});
  a.on_the_spot = can({0, 0, kTurn});
  return a;
}

// A car's front wheels turn by at most kSteeringLimit; others steer as they like.
double least_radius(const std::string& kinematics, const robots::WheeledRobot& robot, const Vector& z) {
  if (kinematics != "bicycle" && kinematics != "ackermann") return 0;
  double radius = 0.1;
  for (; radius < 100; radius *= 1.05) {
    const Vector signals = robot.inverse({kSpeed, 0, kSpeed / radius}, z);
    bool reachable = true;
    for (Eigen::Index i = robot.drive_count(); i < signals.size(); ++i)
      reachable = reachable && std::abs(signals[i]) <= kSteeringLimit;
    if (reachable) break;
  }
  return radius;
}

Phase ahead(double length) {
  return {kSpeed, 0, 0, length / kSpeed};
}
Phase corner(const Abilities& a, double sense) {
  if (a.on_the_spot && a.least_radius == 0) return {0, 0, sense * kTurn, kPi / 2 / kTurn};
  const double radius = std::max(a.least_radius, 0.4), omega = kSpeed / radius;
  return {kSpeed, 0, sense * omega, kPi / 2 / omega};
}
Phase circle(const Abilities& a, double sense) {
  const double radius = std::max(1.3 * a.least_radius, 0.6), omega = kSpeed / radius;
  return {kSpeed, 0, sense * omega, 2 * kPi / omega};
}

std::vector<DemoDrive> drives_of(const Abilities& a) {
  std::vector<DemoDrive> drives;
  for (const double sense : {-1.0, 1.0}) {
    DemoDrive square{sense > 0 ? "square_ccw" : "square_cw",
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

// Share of the commanded speed t seconds into a phase that lasts so much longer that its length stays.
double ramp(double t, double seconds) {
  const double all = seconds + kRamp;
  return std::clamp(std::min(t, all - t) / kRamp, 0.0, 1.0);
}

// Twists of the intervals, one column each, 3 x N; m/s and rad/s.
Matrix twists_of(const DemoDrive& drive) {
  std::vector<Eigen::Vector3d> list(10, Eigen::Vector3d::Zero());
  for (const Phase& phase : drive.phases)
    for (double t = kStep / 2; t < phase.seconds + kRamp; t += kStep)
      list.push_back(ramp(t, phase.seconds) * Eigen::Vector3d(phase.vx, phase.vy, phase.omega));
  list.insert(list.end(), 10, Eigen::Vector3d::Zero());
  Matrix twists(3, static_cast<Eigen::Index>(list.size()));
  for (Eigen::Index k = 0; k < twists.cols(); ++k) twists.col(k) = list[static_cast<std::size_t>(k)];
  return twists;
}

double to_grid(double value, double quantum) {
  return std::round(value / quantum) * quantum;
}
// Poses are written with seven digits behind the point.
double to_pose_grid(double value) {
  return std::round(value * 1e7) / 1e7;
}

// Servos follow their commands loosely, each in its own rhythm: without that the wheels of a robot that
// drives without slip tell no more than its twist, which is three numbers.
class Wander {
 public:
  explicit Wander(Random& noise) {
    for (Part& part : parts_)
      part = {noise.uniform(0.3, 0.6), noise.uniform(2, 15), noise.uniform(0, 2 * kPi)};
  }
  // In [-1.2, 1.2].
  double at(double t) const {
    double sum = 0;
    for (const Part& part : parts_) sum += part.size * std::sin(2 * kPi * t / part.period + part.phase);
    return sum;
  }

 private:
  struct Part {
    double size, period, phase;
  };
  std::array<Part, 2> parts_;
};

class RobotDemo {
 public:
  explicit RobotDemo(const Robot& robot) : robot_(robot), model_(robot.table) {}

  Vector truth(Random& noise) const {
    Vector z = model_.nominal();
    for (Eigen::Index i = 0; i < z.size(); ++i) {
      const RobotParameter& p = robot_.parameters[static_cast<std::size_t>(i)];
      if (p.lower == p.upper) continue;
      const double share = noise.uniform(-1, 1);
      // Digits that people can compare.
      z[i] = to_pose_grid(p.unit == "m" ? z[i] + 0.04 * share * (z[i] != 0 ? z[i] : 0.1 * (p.upper - p.lower))
                          : p.unit == "rad" ? z[i] + 2 * kDegree * share
                                            : z[i] * (1 + 0.03 * share));
      z[i] = std::clamp(z[i], p.lower, p.upper);
    }
    return z;
  }

  Recording record(const DemoDrive& drive, const Vector& z, Random& noise) const {
    const Matrix twists = twists_of(drive);
    const Eigen::Index intervals = twists.cols();
    Matrix motion(3, intervals), poses(3, intervals + 1);
    Matrix signals(static_cast<Eigen::Index>(model_.signals().size()), intervals);
    std::vector<Wander> wander;
    for (Eigen::Index i = 0; i < signals.rows(); ++i) wander.emplace_back(noise);
    Vector held = Vector::Zero(signals.rows());
    for (Eigen::Index k = 0; k < intervals; ++k) {
      held = model_.inverse(twists.col(k), z, held);
      const double t = kStep * (static_cast<double>(k) + 0.5);
      for (Eigen::Index i = 0; i < signals.rows(); ++i) {
        const double w = wander[static_cast<std::size_t>(i)].at(t);
        signals(i, k) = i < model_.drive_count() ? kStep * held[i] * (1 + kDriveWander * w)
                                                 : held[i] + kSteeringWander * w;
      }
    }
    model_.twists(signals, z, motion);
    robots::integrate(robot_.rule, motion, Eigen::Vector3d::Zero(), poses);
    Recording r;
    for (Eigen::Index k = 0; k <= intervals; ++k) {
      r.time_us.push_back(kStep_us * k);
      r.reference.x.push_back(to_pose_grid(poses(0, k) + noise.normal(kPositionNoise)));
      r.reference.y.push_back(to_pose_grid(poses(1, k) + noise.normal(kPositionNoise)));
      r.reference.theta.push_back(to_pose_grid(poses(2, k) + noise.normal(kHeadingNoise)));
    }
    for (Eigen::Index row = 0; row < signals.rows(); ++row) r.signals.push_back(reported(row, signals));
    return r;
  }

 private:
  // Counters and angle sensors see multiples; what a counter leaves out of one increment is in the next.
  Signal reported(Eigen::Index row, const Matrix& signals) const {
    const double quantum = 2 * kPi / kCounts;
    const bool drives = row < model_.drive_count();
    Signal signal{model_.signals()[static_cast<std::size_t>(row)],
                  drives ? SignalKind::Increment : SignalKind::Angle,
                  {drives ? 0.0 : to_grid(signals(row, 0), quantum)}};
    double turned = 0, counted = 0;
    for (Eigen::Index k = 0; k < signals.cols(); ++k) {
      if (!drives) {
        signal.values.push_back(to_grid(signals(row, k), quantum));
        continue;
      }
      turned += signals(row, k);
      const double counts = std::round(turned / quantum);
      signal.values.push_back((counts - counted) * quantum);
      counted = counts;
    }
    return signal;
  }

  const Robot& robot_;
  robots::WheeledRobot model_;
};

}  // namespace

Dataset make_robot_demo(const std::string& kinematics, std::uint64_t seed) {
  Dataset d;
  d.robot = robot_of_class(kinematics, {});
  d.name = "demo_" + kinematics;
  d.description = fmt::format("made up: {}, true parameters known", robots::layout(kinematics).description);
  d.provenance = {"made by odobench, problems/simulation/robot_demo.hpp",
                  "MIT",
                  fmt::format("bench demo --robot={} --seed={}", kinematics, seed),
                  {}};
  const RobotDemo demo(d.robot);
  Random of_truth(mixed_seed(seed, 1'000'000));
  const Vector truth = demo.truth(of_truth);
  const robots::WheeledRobot model(d.robot.table);
  Abilities can = abilities(model, truth);
  can.least_radius = least_radius(kinematics, model, truth);
  const std::vector<DemoDrive> drives = drives_of(can);
  for (const DemoDrive& drive : drives) {
    d.trajectories.push_back({drive.name, drive.description});
    for (int repetition = 1; repetition <= kRepetitions; ++repetition) {
      Random noise(mixed_seed(seed, d.recordings.size()));
      Recording r = demo.record(drive, truth, noise);
      r.trajectory = drive.name;
      r.repetition = repetition;
      r.id = fmt::format("{}_{}", drive.name, repetition);
      d.recordings.push_back(std::move(r));
    }
  }
  d.known_parameters = {{"truth", "the parameters that the drives were made with",
                         std::vector<double>(truth.begin(), truth.end())}};
  return d;
}

}  // namespace odobench
