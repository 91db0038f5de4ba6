#include "problems/simulation/demo_generator.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/angle.hpp"
#include "base/random.hpp"
#include "datasets/robot_4wis4wid.hpp"
#include "problems/robots/four_wheel_steering.hpp"

namespace odobench {
namespace {

constexpr int kDemoRepetitions = 5;

constexpr std::int64_t kPeriod_us = 125'000;
constexpr double kJitter_us = 6'000;
constexpr double kLateShare = 0.02,
                 kLate_us = 60'000;  // now and then a message is late, by up to this much more
constexpr double kRest = 1.0;        // standing before and after the drive, s
constexpr double kRamp = 0.5;        // starting and braking, s

constexpr double kSteeringQuantum = 2 * kPi / 4096;     // rad
constexpr double kSpeedQuantum = 0.229 * 2 * kPi / 60;  // rad/s
constexpr double kPositionNoise = 1.5e-4;               // m
constexpr double kHeadingNoise = 5e-5;                  // rad
constexpr double kPoseGrid = 1e7;                       // poses are multiples of 1 / kPoseGrid

// a1..a4, b1..b4, r1..r4, m. Nominal: 0.1125 in absolute value, and 0.0254.
constexpr std::array<double, 3 * kWheelCount> kTruth = {0.1160,  -0.1148, -0.1106, 0.1089,  0.1078, 0.1174,
                                                        -0.1095, -0.1140, 0.0258,  0.02645, 0.0248, 0.0251};

// Commanded body velocity while driving (m/s, rad/s) and for how long, s.
struct Command {
  double vx, vy, omega, duration;
};

// In the order of trajectories_4wis4wid().
constexpr std::array<Command, 6> kCommands = {{
    {0.05, 0, 0, 80},
    {0, 0.05, 0, 80},
    {0.5 * 2 * kPi / 80, 0, 2 * kPi / 80, 80},
    {0.5 * 2 * kPi / 80, 0, -2 * kPi / 80, 80},
    {0, 0, 2 * kPi / 40, 40},
    {0, 0, -2 * kPi / 40, 40},
}};

double to_grid(double value, double quantum) {
  return std::round(value / quantum) * quantum;
}
// Divided by the grid, not multiplied by its inverse: the result is the double nearest to the decimal
// fraction.
double to_pose_grid(double value) {
  return std::round(value * kPoseGrid) / kPoseGrid;
}

// What one wheel does around its command. Times in s since the drive began to move.
struct WheelPlay {
  double steering, speed;  // commanded, rad and rad/s
  double offset, swing;    // of the steering servo, rad
  double wander, wander_period, wander_phase;
  double speed_wander, speed_period, speed_phase, overshoot;

  WheelPlay(const Command& c, double a, double b, Random& noise) {
    const double vx = c.vx - c.omega * b, vy = c.vy + c.omega * a;
    steering = std::atan2(vy, vx);
    speed = std::hypot(vx, vy) / kWheelRadius;
    // The servos turn by at most a quarter to either side; beyond that the wheel runs backwards.
    constexpr double quarter = kPi / 2 + 1e-9;
    if (std::abs(steering) > quarter) {
      steering -= std::copysign(kPi, steering);
      speed = -speed;
    }
    offset = noise.normal(0.4 * kDegree);
    swing = noise.normal(6 * kDegree);
    wander = noise.uniform(0.8, 2.0) * kDegree;
    wander_period = noise.uniform(7, 25);
    wander_phase = noise.uniform(0, 2 * kPi);
    speed_wander = noise.uniform(0.01, 0.03);
    speed_period = noise.uniform(5, 20);
    speed_phase = noise.uniform(0, 2 * kPi);
    overshoot = noise.uniform(0.5, 1.0);
  }
  double steering_at(double t) const {
    if (t < 0) return steering + offset + swing;
    return steering + offset + swing * std::exp(-t / 1.5) +
           wander * std::sin(2 * kPi * t / wander_period + wander_phase);
  }
  double speed_at(double t) const {
    return speed * (1 + overshoot * std::exp(-t / 0.7) +
                    speed_wander * std::sin(2 * kPi * t / speed_period + speed_phase));
  }
};

// Share of the commanded speed: 0 standing, 1 driving, linear in between.
double throttle(double t, double duration) {
  if (t <= 0 || t >= duration + kRamp) return 0;
  return std::min({1.0, t / kRamp, (duration + kRamp - t) / kRamp});
}

std::vector<std::int64_t> make_stamps(double seconds, Random& noise) {
  std::vector<std::int64_t> stamps = {0};
  const auto count = static_cast<std::int64_t>(seconds * 1e6) / kPeriod_us;
  for (std::int64_t k = 1; k < count; ++k) {
    double delay = noise.uniform(-kJitter_us, kJitter_us);
    if (noise.uniform(0, 1) < kLateShare) delay += noise.uniform(0, kLate_us);
    stamps.push_back(k * kPeriod_us + static_cast<std::int64_t>(std::floor(delay)));
  }
  return stamps;
}

// In the world frame at heading theta, from sample k of the wheel signals.
robots::PublishedVelocity velocity(const Recording& r, std::size_t k, double theta) {
  return robots::published_velocity(theta, [&](std::size_t i) {
    return robots::SteeredWheel{kTruth[i], kTruth[kWheelCount + i],
                                kTruth[2 * kWheelCount + i] * wheel_speed_of(r, i)[k], steering_of(r, i)[k]};
  });
}

// (3.1) from the origin, seen by the motion capture.
void add_poses(Recording& r, Random& noise) {
  double x = 0, y = 0, theta = 0;
  for (std::size_t k = 0; k < r.size(); ++k) {
    r.reference.x.push_back(to_pose_grid(x + noise.normal(kPositionNoise)));
    r.reference.y.push_back(to_pose_grid(y + noise.normal(kPositionNoise)));
    r.reference.theta.push_back(to_pose_grid(theta + noise.normal(kHeadingNoise)));
    if (k + 1 == r.size()) break;
    const double dt = static_cast<double>(r.time_us[k + 1] - r.time_us[k]) * 1e-6;
    const auto [vx, vy, omega] = velocity(r, k, theta);
    x += dt * vx;
    y += dt * vy;
    theta += dt * omega;
  }
}

Recording make_recording(const Command& command, const Robot& robot, Random& noise) {
  std::vector<WheelPlay> wheels;
  for (std::size_t i = 0; i < kWheelCount; ++i)
    wheels.emplace_back(command, robot.parameters[i].nominal, robot.parameters[kWheelCount + i].nominal,
                        noise);
  Recording r = recording_4wis4wid();
  r.time_us = make_stamps(2 * kRest + kRamp + command.duration, noise);
  for (const std::int64_t stamp : r.time_us) {
    const double t = static_cast<double>(stamp) * 1e-6 - kRest;
    const double share = throttle(t, command.duration);
    for (std::size_t i = 0; i < kWheelCount; ++i) {
      steering_of(r, i).push_back(to_grid(wheels[i].steering_at(t), kSteeringQuantum));
      wheel_speed_of(r, i).push_back(share > 0 ? to_grid(share * wheels[i].speed_at(t), kSpeedQuantum) : 0.0);
    }
  }
  add_poses(r, noise);
  return r;
}

}  // namespace

Dataset make_demo_dataset(std::uint64_t seed) {
  Dataset d;
  d.name = "demo";
  d.description =
      "synthetic: six trajectories, five drives each, of a robot with known true parameters, 8 Hz, capture "
      "noise 0.15 mm and 0.05 mrad";
  d.robot = robot_4wis4wid();
  d.trajectories = trajectories_4wis4wid();
  d.known_parameters = {
      {"truth", "the parameters that the drives were made with", {kTruth.begin(), kTruth.end()}}};
  d.provenance.source = "made by odobench, datasets/demo_generator.hpp";
  d.provenance.licence = "MIT";
  d.provenance.made_by = fmt::format("bench demo --seed={}", seed);
  for (std::size_t t = 0; t < d.trajectories.size(); ++t)
    for (int repetition = 1; repetition <= kDemoRepetitions; ++repetition) {
      Random noise(mixed_seed(seed, d.recordings.size()));
      Recording r = make_recording(kCommands[t], d.robot, noise);
      r.trajectory = d.trajectories[t].name;
      r.repetition = repetition;
      r.id = fmt::format("{}_{}", r.trajectory, repetition);
      d.recordings.push_back(std::move(r));
    }
  return d;
}

}  // namespace odobench
