// Drives of the four-wheel robot: voltages and steering over time, the resulting motion, and the three
// experiments of T. Stirblys' thesis (section 3.2).
#pragma once

#include <functional>
#include <vector>

#include "problems/simulation/motors/integrate.hpp"
#include "problems/simulation/motors/robot.hpp"

namespace odobench::dynamics {

// From the end of the segment before it (0 for the first) until `until_s`.
struct Segment {
  double until_s = 0;
  PerWheel voltage{};   // V
  PerWheel steering{};  // rad, within a quarter turn to either side
  bool ramp = false;    // go there linearly from the segment before (zeros before the first); else jump
};

struct DriveSetup {
  RobotParameters robot;
  ModelOptions model;
  IntegrationOptions integration;
  std::vector<Segment> segments;

  // Throws std::invalid_argument naming what is wrong: parameters, options, no segments, times that do not
  // increase, steering beyond a quarter turn, values that are not finite or beyond any robot (a day, 1000 V),
  // motors whose current settles so fast that DormandPrince would take more than kMostSteps steps.
  void validate() const;
};

// Inputs at time t inside segment `index`.
Inputs inputs_at(const std::vector<Segment>& segments, std::size_t index, double t);

struct Sample {
  double time_s = 0;
  Inputs inputs;  // in force just before time_s (at 0: just after)
  State state{};
  State rates{};  // with these inputs
};

// Samples of one drive at most: with their texts 1.2 kB each.
inline constexpr std::int64_t kMostSamples = 2'000'000;

// Throws std::invalid_argument, which names the field, for step_s <= 0 and for a drive of more than
// kMostSamples samples or, with fixed steps, kMostSteps steps. The setup must be valid.
void check_size(const DriveSetup& setup, double step_s);

// From rest at the origin. Samples at 0, step_s, 2 step_s, ... up to the end of the last segment (which has a
// sample when it is a multiple within 1e-9 s). Throws std::invalid_argument on a bad setup or size,
// std::runtime_error when the integration fails.
std::vector<Sample> simulate_drive(const DriveSetup& setup, double step_s);

// exp1_steered: 6 V, wheels 1, 4 at -pi/6 and 2, 3 at +pi/6, 50 s. exp2_circle: 6, 6, 9, 9 V, 50 s.
// exp3_arc_then_straight: 20 s as exp2, then 6 V everywhere until 50 s.
// filter_run: 6 V and, on wheels 3 and 4, kHintVoltageStep more; 20 s.
// Throws std::invalid_argument on another name.
std::vector<Segment> experiment(const std::string& name);
std::vector<std::string> experiment_names();

}  // namespace odobench::dynamics
