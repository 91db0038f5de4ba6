// A synthetic data set with known true parameters: what the program runs on when no recordings are given, and
// what the solvers are tested on.
#pragma once

#include <cstdint>

#include "datasets/dataset.hpp"

namespace odobench {

// The seed of the set in datasets/demo/.
inline constexpr std::uint64_t kDemoSeed = 2024;

// Six trajectories, five repetitions each, of the robot robot_4wis4wid() whose true parameters ("truth" in
// known_parameters, the same for every seed) lie 1 to 4.4 % off the nominal ones, inside the box.
//
// Each drive stands, starts, drives the thesis' trajectory and stands again, sampled at 8 Hz with jittered
// stamps:
//   - the wheels are commanded by nominal inverse kinematics: wheel i has the velocity (vx - om b_i, vy + om
//   a_i);
//   - steering adds a servo offset, a slow wander and a swing that dies out after the start; wheel speed adds
//   a wander
//     and an overshoot at the start: together they excite every parameter;
//   - encoders report multiples of 2 pi / 4096 rad and 0.229 rpm; the wheels do what the encoders report;
//   - the true pose follows (2.16)-(2.17), (3.1) of the thesis with the true parameters, from sample to
//   sample (Euler, the
//     model that is fitted: its residuals at the truth are the capture noise alone);
//   - motion capture adds normal noise of 0.15 mm and 0.05 mrad.
// Poses are rounded to 1e-7 m and rad, so that the set has the same bytes everywhere although sin and cos
// differ in their last bits between C libraries. The same seed gives the same set.
Dataset make_demo_dataset(std::uint64_t seed = kDemoSeed);

}  // namespace odobench
