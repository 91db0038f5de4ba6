// What is no number, and how large one in a data file may be.
#pragma once

#include <cmath>
#include <limits>

namespace odobench {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

// No quantity that a robot meets comes near it, and the square of a product of two such numbers can still be
// summed in doubles: what is computed from them stays finite.
inline constexpr double kLargestNumber = 1e50;

// False for what is not finite, too.
inline bool in_range(double value) {
  return std::abs(value) <= kLargestNumber;
}

}  // namespace odobench
