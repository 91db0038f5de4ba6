// What the sensors of the four-wheel robot tell during a drive, and the truth in the frame of the sensor
// filter of T. Stirblys' thesis (section 2.2).
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "problems/simulation/motors/drive.hpp"

namespace odobench::dynamics {

// One row per sample, of the interval that ends there.
struct SensorRow {
  double time_s = 0;
  PerWheel encoder_m{};     // travel of each wheel's rim, r times its turn, m
  double ax = 0, ay = 0;    // acceleration, m/s2
  double yaw_step_deg = 0;  // rotation, counter-clockwise, deg
  PerWheel steering{};      // rad
};

// The same without noise in the filter frame, which is turned against the body by alpha = atan(b / a): a body
// vector (u, v) is (u cos alpha - v sin alpha, u sin alpha + v cos alpha) there (2.20)-(2.23).
struct TruthRow {
  double sx = 0, sy = 0;                                 // displacement of the centre in the interval, m
  double dtheta_deg = 0;                                 // counter-clockwise
  double ax = 0, ay = 0;                                 // m/s2
  std::array<double, kWheels> encoder_x{}, encoder_y{};  // displacement of each wheel's centre, m
};

// Variances of white Gaussian noise.
struct SensorNoise {
  double encoder_m2 = 3e-5;
  double acceleration_m2_s4 = 0.01;
  double yaw_deg2 = 0.2;
  void validate() const;  // throws std::invalid_argument on a negative or non-finite one
};

enum class AccelerationFrame {
  Body,   // what an accelerometer on the robot feels
  World,  // what (2.17)-(2.18) deliver; the thesis feeds this to its filter
};

struct SensorRun {
  std::vector<SensorRow> rows;
  std::vector<TruthRow> truth;
};

// The first row holds noise and steering only: nothing has moved before it. `normal` gives standard
// normal numbers; it is called seven times a row, in the order of the columns, zero variances included.
// Displacements within an interval are taken in the body frame at its middle heading.
SensorRun sense(const RobotParameters& robot, const std::vector<Sample>& samples, AccelerationFrame frame,
                const SensorNoise& noise, const std::function<double()>& normal);

// time_s,enc1_m..enc4_m,ax_m_s2,ay_m_s2,yaw_step_deg[,psi1_rad..psi4_rad]; shortest numbers that read back as
// the same bits, lines end in \n. The steering columns come when a wheel ever is steered.
std::string sensor_csv(const std::vector<SensorRow>& rows);
// sx,sy,dtheta_deg,ax,ay,enc1x,enc1y,...,enc4y
std::string truth_csv(const std::vector<TruthRow>& rows);
// time_s, voltages, steering, currents, speeds, velocity, pose, rotation, accelerations and the two balances.
std::string state_csv(const RobotParameters& robot, const std::vector<Sample>& samples);

}  // namespace odobench::dynamics
