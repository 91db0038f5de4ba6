// Angles in radians.
#pragma once

#include <cmath>
#include <numbers>

namespace odobench {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kDegree = kPi / 180;  // rad

// To (-pi, pi]; an angle inside keeps its bits.
inline double wrapped_angle(double a) {
  if (a > -kPi && a <= kPi) return a;
  const double r = std::remainder(a, 2 * kPi);
  return r <= -kPi ? kPi : r;
}

}  // namespace odobench
