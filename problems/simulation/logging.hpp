// What the loggers make of a drive: quanta, noise, delays, losses.
#pragma once

#include <vector>

#include "base/random.hpp"
#include "problems/simulation/recording_simulator.hpp"

namespace odobench::simulate {

// Messages of the wheels, one per tick, received in order.
class WheelLogger {
 public:
  WheelLogger(const Odometry& options, Random& noise) : options_(options), noise_(noise) {}
  // Appends the message of time t and returns it.
  const WheelMessage& record(double t, const WheelState& wheels, const PerWheel& angles,
                             std::vector<WheelMessage>& messages);

 private:
  const Odometry& options_;
  Random& noise_;
  double free_at_s_ = 0;  // a stall holds up what comes after it
};

// Messages of the motion capture about a path given every `tick_s`, linear in between.
void log_capture(const Capture& options, const std::vector<Pose>& path, double tick_s, Random& noise,
                 std::vector<CaptureMessage>& messages);

}  // namespace odobench::simulate
