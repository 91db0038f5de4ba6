#include "problems/simulation/recording_simulator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/angle.hpp"
#include "base/error.hpp"
#include "base/random.hpp"
#include "datasets/import/vitko2024/synchronise.hpp"
#include "datasets/import/vitko2024/vitko2024_join.hpp"
#include "datasets/robot_4wis4wid.hpp"
#include "problems/simulation/logging.hpp"
#include "problems/simulation/plant.hpp"

namespace odobench::simulate {
namespace {

constexpr double kLargeSteering = kPi / 6;  // above: steered before the drive begins
constexpr double kFarSteering = kPi / 3;    // above: always
constexpr double kSteeredBefore = 0.95;     // of such drives
constexpr std::size_t kExactIdle = 60;      // ticks

double squared_uniform(const Range& r, Random& noise) {
  const double u = noise.uniform(0, 1);
  return r.low + (r.high - r.low) * u * u;
}

// The robot's controller with its own odometry.
class Controller {
 public:
  Controller(const RecordingScenario& s, const Drive& drive, double lead_s)
      : control_(s.control),
        drive_(drive),
        lead_s_(s.control.closed_loop ? lead_s : 0),
        tick_s_(1 / s.odometry.rate_hz),
        delay_ticks_(static_cast<std::size_t>(std::lround(s.control.delay_s * s.odometry.rate_hz))) {}

  // The state measured at a tick moved the robot since then: to be called at every tick after the first.
  void measured(const WheelState& wheels) {
    const Twist t = forward_published(control_.believed, wheels);
    const double c = std::cos(pose_.theta), s = std::sin(pose_.theta);
    pose_.x += tick_s_ * (c * t.vx - s * t.vy);
    pose_.y += tick_s_ * (s * t.vx + c * t.vy);
    pose_.theta += tick_s_ * t.omega;
  }

  // Body velocity wanted `t` seconds after the drive began; nothing when the reference has reached its end.
  std::optional<Twist> command(double t) {
    const double ahead = t + lead_s_;
    if (ahead >= drive_.duration()) return std::nullopt;
    const Twist wanted = drive_.reference_twist(ahead);
    if (!control_.closed_loop) return wanted;
    const Pose reference = drive_.reference(ahead);
    const double c = std::cos(pose_.theta), s = std::sin(pose_.theta);
    const double dx = reference.x - pose_.x, dy = reference.y - pose_.y;
    errors_.push_back({c * dx + s * dy, -s * dx + c * dy, reference.theta - pose_.theta});
    const std::size_t now = errors_.size() - 1;
    const Pose& e = errors_[now > delay_ticks_ ? now - delay_ticks_ : 0];
    const double ct = std::cos(reference.theta - pose_.theta), st = std::sin(reference.theta - pose_.theta);
    return Twist{ct * wanted.vx - st * wanted.vy + control_.gain_position * e.x,
                 st * wanted.vx + ct * wanted.vy + control_.gain_position * e.y,
                 wanted.omega + control_.gain_heading * e.theta};
  }

 private:
  const Control& control_;
  const Drive& drive_;
  double lead_s_, tick_s_;
  std::size_t delay_ticks_;
  Pose pose_;
  std::vector<Pose> errors_;
};

// Of the two folds of a command the one nearer to where the wheels are: a servo does not swing round by half
// a turn because a command passes 90 degrees by a hair.
WheelState near_to(WheelState command, const PerWheel& held) {
  for (std::size_t i = 0; i < kWheelCount; ++i) {
    constexpr double slack = kPi / 4;  // beyond it a servo does swing round
    const double other = command.steering[i] + (command.steering[i] > 0 ? -kPi : kPi);
    if (std::abs(other - held[i]) < std::abs(command.steering[i] - held[i]) &&
        std::abs(other) <= kPi / 2 + slack) {
      command.steering[i] = other;
      command.speed[i] = -command.speed[i];
    }
  }
  return command;
}

Pose start_pose(const StartPose& start, Random& noise) {
  constexpr double limit = 0.007;
  const double x = noise.uniform(-1, 1) * start.position, y = noise.uniform(-1, 1) * start.position;
  return {x, y, std::clamp(noise.normal(start.heading), -limit, limit)};
}

bool steers_beyond(const WheelState& first, double angle) {
  return std::any_of(first.steering.begin(), first.steering.end(),
                     [angle](double d) { return std::abs(d) > angle; });
}

}  // namespace

Twist true_twist(const TrueRobot& robot, const WheelState& wheels) {
  return robot.kinematics == Kinematics::Published
             ? forward_published(robot.parameters, wheels, robot.contact_offset)
             : forward_least_squares(robot.parameters, wheels, robot.contact_offset);
}

DriveLogs simulate_logs(const RecordingScenario& s, const Drive& drive, std::uint64_t seed) {
  Random noise(seed);
  DriveLogs logs;
  const double tick_s = 1 / s.odometry.rate_hz;
  const double before = squared_uniform(s.idle.before_s, noise),
               after = squared_uniform(s.idle.after_s, noise);
  const double lead = noise.uniform(s.control.lead_s.low, s.control.lead_s.high);
  Plant plant(s, drive.name, start_pose(s.start, noise), noise);
  Controller controller(s, drive, lead);
  WheelState command;
  const PerWheel standing{};  // the loop never wants a wheel to stand exactly
  const WheelState first = drive.command(s.control.believed, drive.phases.front().twist);
  const double least = noise.uniform(0, 1) < kSteeredBefore ? kLargeSteering : kFarSteering;
  if (steers_beyond(first, least)) {
    command.steering = first.steering;
    plant.steer_at_once(first.steering);
  }
  const auto begin_tick = static_cast<std::int64_t>(std::ceil(before / tick_s));
  logs.begin_s = static_cast<double>(begin_tick) * tick_s;

  WheelLogger wheel_logger(s.odometry, noise);
  std::vector<Pose> path;  // at the ticks
  std::int64_t end_tick = -1;
  for (std::int64_t tick = 0;; ++tick) {
    const double t = static_cast<double>(tick) * tick_s;
    const WheelMessage& message = wheel_logger.record(t, plant.wheels(), plant.angles(), logs.wheels);
    path.push_back(plant.pose());
    if (end_tick >= 0 && t >= logs.end_s + after) break;
    if (tick >= begin_tick && end_tick < 0) {
      if (const auto twist = controller.command(t - logs.begin_s)) {
        command = near_to(drive.command(s.control.believed, *twist, standing), command.steering);
      } else {
        command.speed = {};
        end_tick = tick;
        logs.end_s = t;
      }
    }
    plant.advance(command, tick_s, noise);
    controller.measured({message.steering, message.speed});
  }
  log_capture(s.capture, path, tick_s, noise, logs.capture);
  logs.true_poses = std::move(path);
  return logs;
}

Recording recording_of(const DriveLogs& logs, std::int64_t* start_us) {
  if (logs.capture.size() < vitko2024::kDroppedSamples + 2)
    throw DataError(
        fmt::format("a simulated drive has {} samples of the motion capture, expected at least {}",
                    logs.capture.size(), vitko2024::kDroppedSamples + 2));
  vitko2024::CaptureLog capture;
  vitko2024::WheelLog wheels;
  for (const CaptureMessage& m : logs.capture) {
    capture.time_us.push_back(m.received_us);
    capture.x.push_back(m.pose.x);
    capture.y.push_back(m.pose.y);
    capture.yaw.push_back(m.pose.theta);
  }
  for (const WheelMessage& m : logs.wheels) {
    wheels.time_us.push_back(m.received_us);
    for (std::size_t i = 0; i < kWheelCount; ++i) {
      wheels.steering[i].push_back(m.steering[i]);
      wheels.wheel_speed[i].push_back(m.speed[i]);
    }
  }
  make_increasing(capture.time_us);
  make_increasing(wheels.time_us);
  if (start_us != nullptr) *start_us = capture.time_us[vitko2024::kDroppedSamples];
  return vitko2024::join(std::move(capture), wheels);
}

Recording exact_recording(const RecordingScenario& s, const Drive& drive) {
  Recording r = recording_4wis4wid();
  const double tick_s = 1 / s.odometry.rate_hz;
  Pose pose;
  WheelState wheels;
  const auto record = [&](std::int64_t tick) {
    r.time_us.push_back(std::llround(static_cast<double>(tick) * tick_s * 1e6));
    r.reference.x.push_back(pose.x);
    r.reference.y.push_back(pose.y);
    r.reference.theta.push_back(pose.theta);
    for (std::size_t i = 0; i < kWheelCount; ++i) {
      steering_of(r, i).push_back(wheels.steering[i]);
      wheel_speed_of(r, i).push_back(wheels.speed[i]);
    }
  };
  PerWheel held{};
  if (steers_beyond(drive.command(s.control.believed, drive.phases.front().twist), kLargeSteering))
    wheels.steering = drive.command(s.control.believed, drive.phases.front().twist).steering;
  std::int64_t tick = 0;
  for (; tick < static_cast<std::int64_t>(kExactIdle); ++tick) record(tick);
  for (const Phase& phase : drive.phases) {
    wheels = drive.command(s.control.believed, phase.twist, held);
    for (std::size_t i = 0; i < kWheelCount; ++i) held[i] = wheels.steering[i] - drive.steering_offset[i];
    const Twist twist = true_twist(s.truth, wheels);
    const Pose begin = pose;
    const auto ticks = std::max<std::int64_t>(1, std::llround(phase.duration_s / tick_s));
    for (std::int64_t k = 1; k <= ticks; ++k) {
      record(tick++);
      pose = moved(begin, twist, static_cast<double>(k) * tick_s);
    }
  }
  wheels.speed = {};
  for (std::size_t k = 0; k <= kExactIdle; ++k) record(tick++);
  return r;
}

}  // namespace odobench::simulate
