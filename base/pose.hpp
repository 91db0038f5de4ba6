// Where a body in the plane is and how it moves: the structs that all rooms share.
#pragma once

#include <vector>

namespace odobench {

// Velocity of the body in its own frame.
struct Twist {
  double vx = 0, vy = 0, omega = 0;  // m/s, m/s, rad/s
};

struct Pose {
  double x = 0, y = 0, theta = 0;  // m, m, rad; counter-clockwise
};

// One entry per sample in each.
struct PoseTrack {
  std::vector<double> x, y, theta;  // m, m, rad
};

}  // namespace odobench
