// Kinematics of the robot with four steered and driven wheels, J. Vitko, master's thesis, University of
// Zagreb, 2024. Parameters z = (a1..a4, b1..b4, r1..r4), m: wheel i stands at (a_i, b_i), x forward, y left,
// with radius r_i.
#pragma once

#include <array>

#include "base/pose.hpp"
#include "datasets/robot_4wis4wid.hpp"

namespace odobench::simulate {

using Parameters = std::array<double, 3 * kWheelCount>;
using PerWheel = std::array<double, kWheelCount>;

struct WheelState {
  PerWheel steering{};  // rad
  PerWheel speed{};     // rad/s
};

// (2.6): wheel i moves with (vx - omega b_i, vy + omega a_i). The steering angle is its direction, folded
// into (-pi/2, pi/2] by running the wheel backwards where needed; a wheel slower than 1e-9 m/s stands and
// keeps the steering of `held`.
WheelState inverse_kinematics(const Parameters& z, const Twist& twist, const PerWheel& held = {});

// Sideways distance c_i of a wheel's contact point from its steering axis, m: it acts at
// (a_i - c_i sin d_i, b_i + c_i cos d_i).
using ContactOffset = PerWheel;

// (2.16): mean of the wheels' velocities, and their mean rotation with weights that are the pseudo-inverse
// for the symmetric layout only.
Twist forward_published(const Parameters& z, const WheelState& wheels, const ContactOffset& offset = {});
// The true pseudo-inverse of (2.8)-(2.9): the twist whose wheel velocities deviate least from r_i w_i (cos,
// sin) d_i in the sum of squares.
Twist forward_least_squares(const Parameters& z, const WheelState& wheels, const ContactOffset& offset = {});

// Where a body is after moving with a constant twist for `seconds`: an exact arc.
Pose moved(const Pose& from, const Twist& twist, double seconds);

}  // namespace odobench::simulate
