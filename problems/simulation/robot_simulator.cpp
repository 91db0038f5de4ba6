#include "problems/simulation/robot_simulator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "base/angle.hpp"
#include "problems/robots/integration.hpp"

namespace odobench {
namespace {

constexpr std::int64_t kStep_us = 50'000;
constexpr double kMostTurned = 1e6;  // rad in one interval
// Feedback of the robot's own odometry: 1/s ahead and aside, 1/s in heading, 1/m^2 where it cannot go aside.
constexpr double kPositionGain = 1.5, kHeadingGain = 2, kCourseGain = 4;

double multiple_of(double value, double quantum) {
  return std::round(value / quantum) * quantum;
}
// Poses are written with seven digits behind the point.
double seven_digits(double value) {
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

// Counters and angle sensors see multiples; what a counter leaves out of one increment is in the next.
class Sensor {
 public:
  Sensor(bool drives, double counts) : drives_(drives), quantum_(2 * kPi / counts) {}
  double read(double value) {
    if (!drives_) return multiple_of(value, quantum_);
    turned_ += value;
    const double counts = std::round(turned_ / quantum_), increment = (counts - counted_) * quantum_;
    counted_ = counts;
    return increment;
  }

 private:
  bool drives_;
  double quantum_, turned_ = 0, counted_ = 0;
};

// Where the robot believes to be, and what it commands to be where the drive is.
class Pilot {
 public:
  Pilot(robots::IntegrationRule rule, const RobotAbilities& can, const Matrix& twists)
      : rule_(rule), can_(can), poses_(3, twists.cols() + 1) {
    robots::integrate(rule, kRobotStep * twists, Eigen::Vector3d::Zero(), poses_);
  }
  Eigen::Vector3d end() const { return poses_.col(poses_.cols() - 1); }
  void moved(const Eigen::Vector3d& motion) {
    Matrix poses(3, 2);
    robots::integrate(rule_, motion, pose_, poses);
    pose_ = poses.col(1);
  }
  Eigen::Vector3d command(const Eigen::Vector3d& twist, Eigen::Index k) const {
    const Eigen::Vector3d error = poses_.col(k) - pose_;
    const double c = std::cos(pose_[2]), s = std::sin(pose_[2]);
    const Eigen::Vector3d aside(-can_.ahead[1], can_.ahead[0], 0);
    const Eigen::Vector3d seen(c * error[0] + s * error[1], -s * error[0] + c * error[1], 0);
    const double along = seen.dot(can_.ahead), across = seen.dot(aside);
    const double ct = std::cos(error[2]), st = std::sin(error[2]);
    const Eigen::Vector3d own = twist - twist[2] * can_.turn;  // without the turn
    const double v = own.dot(can_.ahead), left = own.dot(aside);
    if (can_.sideways)
      return (ct * v - st * left + kPositionGain * along) * can_.ahead +
             (st * v + ct * left + kPositionGain * across) * aside +
             (twist[2] + kHeadingGain * error[2]) * can_.turn;
    const double speed = v * ct + kPositionGain * along;
    double turn = twist[2] + kHeadingGain * error[2] + kCourseGain * v * across;
    if (can_.least_radius > 0)
      turn = std::clamp(turn, -std::abs(speed) / can_.least_radius, std::abs(speed) / can_.least_radius);
    return speed * can_.ahead + turn * can_.turn;
  }

 private:
  robots::IntegrationRule rule_;
  const RobotAbilities& can_;
  Matrix poses_;
  Eigen::Vector3d pose_ = Eigen::Vector3d::Zero();
};

}  // namespace

Vector nominal_values(const Robot& robot) {
  Vector z(static_cast<Eigen::Index>(robot.parameters.size()));
  for (Eigen::Index i = 0; i < z.size(); ++i) z[i] = robot.parameters[static_cast<std::size_t>(i)].nominal;
  return z;
}

RobotSimulator::RobotSimulator(Robot robot, const RobotNoise& noise)
    : robot_(std::move(robot)), model_(robot_.table), noise_(noise) {}

double RobotSimulator::samples(const RobotDrive& drive, const RobotAbilities& can) {
  return static_cast<double>(twists_of(drive, can).cols() + 1);
}

RobotRun RobotSimulator::record(const RobotDrive& drive, const RobotAbilities& can, const Vector& truth,
                                const Vector& believed, Random& random, bool feedback) const {
  const Matrix twists = twists_of(drive, can);
  const Eigen::Index intervals = twists.cols(), drives = model_.drive_count();
  Matrix motion(3, intervals), poses(3, intervals + 1);
  Matrix signals(static_cast<Eigen::Index>(model_.signals().size()), intervals),
      read(signals.rows(), intervals);
  std::vector<Wander> wander;
  std::vector<Sensor> sensors;
  for (Eigen::Index i = 0; i < signals.rows(); ++i) {
    wander.emplace_back(random);
    sensors.emplace_back(i < drives, noise_.counts);
  }
  Pilot pilot(robot_.rule, can, twists);
  Vector held = Vector::Zero(signals.rows());
  Matrix step(3, 1);
  for (Eigen::Index k = 0; k < intervals; ++k) {
    held = model_.inverse(feedback ? pilot.command(twists.col(k), k) : twists.col(k), believed, held);
    const double t = kRobotStep * (static_cast<double>(k) + 0.5);
    for (Eigen::Index i = 0; i < signals.rows(); ++i) {
      const double w = wander[static_cast<std::size_t>(i)].at(t);
      signals(i, k) = i < drives ? kRobotStep * held[i] * (1 + noise_.drive_wander * w)
                                 : held[i] + noise_.steering_wander * w;
      if (!(std::abs(signals(i, k)) <= kMostTurned))
        throw std::invalid_argument(
            fmt::format("drive '{}': {} would change by {:.3g} rad in {} s, expected at "
                        "most {:g}: a radius is too small for the robot",
                        drive.name, model_.signals()[static_cast<std::size_t>(i)], signals(i, k), kRobotStep,
                        kMostTurned));
      read(i, k) = sensors[static_cast<std::size_t>(i)].read(signals(i, k));
    }
    if (!feedback) continue;
    model_.twists(read.col(k), believed, step);
    pilot.moved(step.col(0));
  }
  model_.twists(signals, truth, motion);
  robots::integrate(robot_.rule, motion, Eigen::Vector3d::Zero(), poses);
  RobotRun run;
  Recording& r = run.recording;
  for (Eigen::Index k = 0; k <= intervals; ++k) {
    r.time_us.push_back(kStep_us * k);
    r.reference.x.push_back(seven_digits(poses(0, k) + random.normal(noise_.position)));
    r.reference.y.push_back(seven_digits(poses(1, k) + random.normal(noise_.position)));
    r.reference.theta.push_back(seven_digits(poses(2, k) + random.normal(noise_.heading)));
  }
  for (Eigen::Index i = 0; i < signals.rows(); ++i) {
    const bool drive_signal = i < drives;
    Signal signal{model_.signals()[static_cast<std::size_t>(i)],
                  drive_signal ? SignalKind::Increment : SignalKind::Angle,
                  {drive_signal ? 0.0 : read(i, 0)}};
    for (Eigen::Index k = 0; k < intervals; ++k) signal.values.push_back(read(i, k));
    r.signals.push_back(std::move(signal));
  }
  const Eigen::Vector3d miss = poses.col(intervals) - pilot.end();
  run.position_miss = std::hypot(miss[0], miss[1]);
  run.heading_miss = std::abs(miss[2]);
  return run;
}

}  // namespace odobench
