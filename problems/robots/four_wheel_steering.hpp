// The published velocity of a robot with four steered and driven wheels, J. Vitko, master's thesis,
// University of Zagreb, 2024, in one place: what calibrates, fuses and simulates computes the same bits.
//
// Wheel i stands at (a_i, b_i), runs at v_i = r_i w_i, and is steered by d_i; in a frame turned by -heading
//     vx    = 1/4 sum cos(d_i + heading) v_i                                             (2.16)
//     vy    = 1/4 sum sin(d_i + heading) v_i
//     omega = sum (-b_i cos d_i + a_i sin d_i) / (4 (a_i^2 + b_i^2)) v_i                 (2.17)
// so heading = 0 gives the body frame and the robot's heading the world. With a contact c_i to the left of
// the steering axis, (a_i - c_i sin d_i, b_i + c_i cos d_i) is put for (a_i, b_i).
#pragma once

#include <cmath>
#include <cstddef>

#include "datasets/robot_4wis4wid.hpp"

namespace odobench::robots {

struct SteeredWheel {
  double a, b;        // m
  double speed;       // r w, m/s
  double steering;    // rad
  double offset = 0;  // c, m
};

struct PublishedVelocity {
  double vx = 0, vy = 0, omega = 0;  // m/s, m/s, rad/s
};

// wheel(i) gives the SteeredWheel i = 0, ..., 3.
template <class WheelOf>
PublishedVelocity published_velocity(double heading, const WheelOf& wheel) {
  PublishedVelocity t;
  for (std::size_t i = 0; i < kWheelCount; ++i) {
    const SteeredWheel w = wheel(i);
    const double c = std::cos(w.steering), s = std::sin(w.steering);
    const double a = w.a - w.offset * s, b = w.b + w.offset * c;
    t.vx += std::cos(w.steering + heading) / 4 * w.speed;
    t.vy += std::sin(w.steering + heading) / 4 * w.speed;
    t.omega += (-b * c + a * s) / (4 * (a * a + b * b)) * w.speed;
  }
  return t;
}

}  // namespace odobench::robots
