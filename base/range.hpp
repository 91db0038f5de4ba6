// How large a number in a data file may be.
#pragma once

#include <cmath>

namespace odobench {

// No quantity that a robot meets comes near it, and the square of a product of two such numbers can still be summed in doubles:
// what is computed from them stays finite.
inline constexpr double kLargestNumber = 1e50;

// False for what is not finite, too.
inline bool in_range(double value) {
  return std::abs(value) <= kLargestNumber;
}

}  // namespace odobench
