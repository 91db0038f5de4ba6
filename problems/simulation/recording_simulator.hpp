// One simulated drive: what the robot did, and what the two loggers wrote about it.
#pragma once

#include <cstdint>
#include <vector>

#include "datasets/recording.hpp"
#include "problems/simulation/scenario.hpp"

namespace odobench::simulate {

// Rows as they arrive; times in microseconds since the logs began.
struct WheelMessage {
  std::int64_t received_us = 0;
  std::int64_t stamp_us = 0;  // of the robot's clock, which runs kRobotClockAhead_us ahead
  PerWheel steering{}, speed{};
  PerWheel angle{};  // turned by each wheel, rad
};
struct CaptureMessage {
  std::int64_t received_us = 0;
  std::int64_t stamp_us = 0;  // of the source
  std::int64_t sequence = 0;  // lost messages leave gaps
  Pose pose;
};
inline constexpr std::int64_t kRobotClockAhead_us = 20'000;

struct DriveLogs {
  std::vector<WheelMessage> wheels;
  std::vector<CaptureMessage> capture;
  // The truth: idle before, when the drive began and ended, and the true poses at every tick of the odometry.
  double begin_s = 0, end_s = 0;
  std::vector<Pose> true_poses;
};

// Deterministic in its arguments. The scenario must be valid. Not for exact scenarios.
//
// At every tick of the odometry the robot reads its wheels (quanta, noise), integrates (2.16) with the
// believed parameters, and commands the inverse kinematics of
//     u = R(theta_ref - theta) twist_ref + K e,   e = error of its own odometry delay_s ago,
// where the reference is lead_s ahead: that is the overshoot at the start of the published drives. Between
// ticks the wheels follow through two lags, the steering with its limited rate, bias and wander, and the body
// moves along exact arcs of 4 ms by the true parameters. Drives that begin with more than 30 degrees of
// steering are steered before they begin; with 30 to 60 degrees one in twenty recordings is not.
DriveLogs simulate_logs(const RecordingScenario& scenario, const Drive& drive, std::uint64_t seed);

// The recording that an import makes of the two logs: wheel signals interpolated onto the capture's stamps,
// the first
// 29 samples dropped (vitko2024.hpp). Names are left empty. `start_us`, if not null, receives when the
// recording's time
// 0 is on the clock of the logs. Throws DataError when the motion capture saw too little for that.
Recording recording_of(const DriveLogs& logs, std::int64_t* start_us = nullptr);

// An exact drive: constant commands of the believed inverse kinematics, moved exactly, all on the odometry's
// grid with
// 60 ticks of standing before and after.
Recording exact_recording(const RecordingScenario& scenario, const Drive& drive);

// True velocity of the body for given wheels, without slip.
Twist true_twist(const TrueRobot& robot, const WheelState& wheels);

}  // namespace odobench::simulate
