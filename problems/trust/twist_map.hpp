// What drives of a robot determine: the map from commands to motion.
//
// A controller turns a twist u_cmd into wheel speeds and steering angles by the nominal geometry
// (WheeledRobot::inverse). With parameters z the same signals mean the twist u(z). For wheels whose signals
// enter linearly (all classes but modules with contacts beside their pivots) u = M(z) u_cmd for every command
// that the robot can do, so the entries of M are all that drives with consistent wheels can tell, however
// many there are. For the published mean of four steered wheels they are the six numbers
//     m11 = m22 = 1/4 sum rho_i,  m13 = -1/4 sum rho_i b0_i,  m23 = 1/4 sum rho_i a0_i,  m12 = m21 = 0,
//     m31 = -1/4 sum rho_i b_i/s_i,  m32 = 1/4 sum rho_i a_i/s_i,
//     m33 = 1/4 sum rho_i (a_i a0_i + b_i b0_i)/s_i,   rho_i = r_i/r0_i,  s_i = a_i^2 + b_i^2.
//
// Columns are the commands of the basis that the robot can do:
//   1 m/s along x, 1 m/s along y, 1 rad/s on the spot; of robots that steer and cannot go sideways (tricycle,
//   bicycle, car) an arc to the left and one to the right in place of the spot, which most of them cannot do:
//   1 m/s along x with the curvature +-1/(2 L), L the largest distance of a steered wheel from the origin
//   (about 27 degrees of steering).
// Entries that no free parameter can move are left out: a differential robot cannot go sideways whatever its
// numbers are.
#pragma once

#include <string>
#include <vector>

#include "datasets/robots/robot.hpp"
#include "problems/problem.hpp"

namespace odobench {

enum class TwistEntry {
  Path,   // motion along the command over the command, a factor
  Turn,   // rotation over the commanded one, a factor
  Drift,  // motion across the command, m per m
  Swing,  // rotation per metre driven, rad/m
  Shift   // motion of the origin per radian turned, m/rad
};

struct TwistNumber {
  std::string name;   // "m11": row vx, vy, omega, column x, y, turn; "left_path", "right_turn" of arcs
  std::string words;  // "path factor", "turn per metre along x"
  std::string unit;   // "" of factors, "m/m", "rad/m", "m/rad"
  TwistEntry entry = TwistEntry::Path;
  double nominal = 0, value = 0;
  Vector gradient;  // by all parameters of the problem, in their units
};

struct TwistMap {
  std::vector<TwistNumber> numbers;
  // Whether u = M u_cmd for every command that is a combination of the columns.
  bool linear = true;
  // In words, what no free parameter of this robot moves, and what it cannot be commanded to do.
  std::vector<std::string> remarks;
};

// `parameters`: of the problem, found by the names of the robot's table; of others (a mount, a time offset)
// the gradient is 0. `z`: in their order. Throws what WheeledRobot throws.
TwistMap twist_map(const Robot& robot, const std::vector<ParameterInfo>& parameters, const ConstVectorRef& z);

// M u_cmd by the columns as they are, 3 x 3 (NaN in those of commands that the robot cannot do), at z.
Matrix twist_matrix(const Robot& robot, const std::vector<ParameterInfo>& parameters,
                    const ConstVectorRef& z);

// "path +1.623 +- 0.077 %", "turn along x +1.10 +- 0.19 deg/m", "shift to the left -13.3 +- 4.6 mm/turn";
// without a half width no interval.
std::string words_with(const TwistNumber& number, double half_width);

// The unit in which people read a number and its size: % (of the deviation from nominal), deg/m, mm/rad,
// mm/m.
struct ReadableUnit {
  std::string unit;
  double per_unit = 1;  // value in SI times this
};
ReadableUnit readable_unit(TwistEntry entry);

}  // namespace odobench
