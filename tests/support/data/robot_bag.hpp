// A drive of a two-wheeled robot without motion capture, as a recording of ROS messages.
#pragma once

#include "tests/support/log_writers.hpp"

namespace odobench::testing {

// /joint_states (left_wheel_joint, right_wheel_joint; 50 Hz), /imu (gyro of 0.002 rad/s noise and a bias; 100
// Hz), /odom (the robot's own, by nominal sizes; 10 Hz) and, unless `vision` is false, /rtabmap/odom (a
// camera's odometry; 30 Hz) over 44 s: 3 s of standing at either end, between them eight bends of changing
// curvature, in turns to the left and to the right.
struct RobotBag {
  unsigned seed = 1;  // of the noise and of how sharp the bends are
  bool vision = true;
  double gyro_bias = 0.004;  // rad/s
  int gyro_sign = 1;
  bool z_down = false;  // the camera's frame: y to the right, headings clockwise
  // The camera: its clock, its place on the robot, its drift and noise of poses.
  double clock_ahead_s = 0.083;
  double mount_x = 0.35, mount_y = 0.06, mount_yaw = 2.6;  // m, rad
  double heading_walk = 0.01, position_walk = 0.003;       // rad, m per root of a metre
  double pose_noise = 0.001;                               // m, rad

  static constexpr double kLeft = 0.0504, kRight = 0.04985, kTrack = 0.412, kSeconds = 44;

  WrittenLog messages(RosEncoding encoding) const;
};

}  // namespace odobench::testing
