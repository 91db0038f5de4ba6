// The robot's body and wheels between two commands.
#pragma once

#include <string>

#include "base/random.hpp"
#include "problems/simulation/scenario.hpp"

namespace odobench::simulate {

class Plant {
 public:
  // Draws what stays the same for a recording: servo biases, size of the wander, lost speed of each wheel.
  Plant(const RecordingScenario& scenario, const std::string& drive, const Pose& start, Random& noise);

  void steer_at_once(const PerWheel& steering);
  // Follows a command for `seconds`.
  void advance(const WheelState& command, double seconds, Random& noise);

  const Pose& pose() const { return pose_; }
  WheelState wheels() const;                          // as they are, before any encoder
  const PerWheel& angles() const { return angles_; }  // turned by the wheels, rad

 private:
  const RecordingScenario& scenario_;
  Gains gains_;
  Pose pose_;
  PerWheel steering_{};  // of the servos, without bias and wander
  PerWheel bias_{}, wander_{}, wander_sigma_{};
  PerWheel lagged_{}, speed_{}, angles_{};  // first and second lag
  PerWheel lost_{}, slipping_{};
};

}  // namespace odobench::simulate
