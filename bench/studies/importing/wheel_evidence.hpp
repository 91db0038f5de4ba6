// How each wheel's rate goes with the reference's motion: sign, side and radius without knowing any.
#pragma once

#include <optional>
#include <vector>

#include "datasets/import/logs/log_curves.hpp"

namespace odobench {

struct WheelEvidence {
  double along = 0;      // alpha, 1/m: rate of the wheel per velocity along the heading
  double turning = 0;    // beta, without unit: rate per yaw rate
  double explained = 0;  // share of the rate's sum of squares
  // To the right of the tracked point positive, about in m.
  double side() const { return along != 0 ? turning / along : 0; }
};

// w = alpha v + beta omega by least squares, of all signals; v and omega by differences over 0.2 s every 50
// ms, the reference's stamps less `offset` [s]. The tracked frame may be turned on the robot by any angle: a
// robot that does not go sideways moves it across its way by what turning alone does, which tells the way up
// to forward and backward; forward is where more wheels count up. Empty where they share less than a second
// or the reference does not both drive and turn.
std::vector<WheelEvidence> wheel_evidence(const log_import::LogCurves& curves, double offset);

// A counter that runs over, as raw counts: jumps of 2^bits, 8, 16, 24 or 32 bits, less what it steps
// otherwise.
struct CounterJumps {
  int bits = 0;
  int count = 0;  // jumps
};
// Of a curve in units of `count` each. Nothing where it does not jump, or by something else.
std::optional<CounterJumps> counter_jumps(const log_import::Curve& curve, double count);

// omega = sum share_i rate_i by least squares, over differences of 0.2 s.
struct TurnEvidence {
  std::vector<double> share;  // of each signal: radius over track, negative on the left
  double explained = 0;       // share of omega's sum of squares
};
// Of the heading and all signals. Nothing where they share less than a second, turn by less than 0.1 rad/s or
// do not tell the wheels apart.
std::optional<TurnEvidence> turn_evidence(const log_import::LogCurves& curves);

}  // namespace odobench
