// Points of equal cost by a symmetry of a sum: terms of one form may change places, signs may change
// together.
#pragma once

#include <vector>

#include "problems/problem.hpp"

namespace odobench {

struct Symmetry {
  std::vector<std::vector<int>> terms;  // indices of each exchangeable term's parameters, in the same order
  std::vector<std::vector<int>> signs;  // indices of the parameters of each joint change of sign
};

// x first, then all others: terms! 2^signs points.
std::vector<Vector> equivalent_points(const Vector& x, const Symmetry& symmetry);

}  // namespace odobench
