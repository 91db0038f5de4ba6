// A wheeled robot as data: its wheels, and which numbers of them are to be calibrated.
//
// Body frame: origin where the robot's twist is wanted, x forward, y left, angles counter-clockwise; SI
// units, radians. A wheel turns about a pivot at (x, y). It rolls in the direction phi = mount + gain s +
// zero (s: what its steering sensor reads; phi = mount without one), e = (cos phi, sin phi), n = (-sin phi,
// cos phi), and touches the ground at p = (x, y) + trail e + offset n. With u = velocity of the body at p and
// w = drive speed, a wheel states
//     drive row  (has a drive):    e.u + tan(roller) n.u = radius w
//     side row   (does not slide): n.u = 0
// `roller` is the angle of the rollers' axis from e: 0 for an omni wheel, +-45 degrees for mecanum.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "base/parameter.hpp"

namespace odobench {

// One robot parameter as the set states it; SI units.
using RobotParameter = Parameter;

// A wheel's drive speed is the weighted sum of these signals: one encoder, the mean of two, one counting
// backwards.
struct DriveSignal {
  std::string name;  // e.g. "wheel.right"
  double weight = 1;
};

struct Wheel {
  double x = 0, y = 0;             // pivot, m
  double mount = 0;                // rad
  double radius = 0;               // m
  double roller = 0;               // rad
  double zero = 0;                 // of the steering, rad
  double offset = 0;               // of the contact to the left of the pivot, m
  double trail = 0;                // of the contact ahead of the pivot, m
  double gain = 1;                 // of the steering
  std::vector<DriveSignal> drive;  // none: not driven, or driven without a sensor
  std::string steering;            // "": not steered
  bool slides = false;             // sideways: no side row
};

enum class WheelField { X, Y, Mount, Radius, Roller, Zero, Offset, Trail, Gain };
// As sets and messages name them, in the order of the enumerators.
inline constexpr std::array<std::string_view, 9> kWheelFieldNames = {
    "x", "y", "mount", "radius", "roller", "zero", "offset", "trail", "gain"};

inline constexpr std::array<double Wheel::*, 9> kWheelFieldMembers = {
    &Wheel::x,    &Wheel::y,      &Wheel::mount, &Wheel::radius, &Wheel::roller,
    &Wheel::zero, &Wheel::offset, &Wheel::trail, &Wheel::gain};

inline std::string_view name_of(WheelField field) {
  return kWheelFieldNames[static_cast<std::size_t>(field)];
}
inline double& field_of(Wheel& wheel, WheelField field) {
  return wheel.*kWheelFieldMembers[static_cast<std::size_t>(field)];
}
inline double field_of(const Wheel& wheel, WheelField field) {
  return wheel.*kWheelFieldMembers[static_cast<std::size_t>(field)];
}

// The field's value is what the wheel states plus the sum of factor * parameter over all that bind to it: a
// track b of two wheels at y = 0 binds with -1/2 and 1/2.
struct Binding {
  std::size_t wheel = 0;
  WheelField field = WheelField::X;
  double factor = 1;
};

// Parameters that are equal are one parameter with several bindings. Unit m, rad or ratio; lower == upper:
// held fixed.
struct BoundParameter {
  RobotParameter parameter;
  std::vector<Binding> bindings;
};

enum class TwistRule {
  LeastSquares,  // of all rows
  Mean  // 1/N sum (radius w e, radius w (p x e) / |p|^2), equal to least squares for symmetric layouts
};
inline constexpr std::array<std::string_view, 2> kTwistRuleNames = {"least_squares", "mean"};
// Throws std::invalid_argument for an unknown name. "least-squares" is taken, too.
TwistRule twist_rule(std::string_view name);

struct WheelTable {
  std::vector<Wheel> wheels;
  std::vector<BoundParameter> parameters;
  TwistRule rule = TwistRule::LeastSquares;
};

}  // namespace odobench
