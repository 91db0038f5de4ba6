// Residuals, starts and known optima of the problems of more_garbow_hillstrom.hpp, by the numbers of the
// paper.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "problems/classic/classic_problems.hpp"

namespace odobench {

inline double square(double x) {
  return x * x;
}

struct MghFunction {
  const char* name;
  const char* title;  // with its number in the paper
  int dimension;      // the usual one
  DimensionRule dimensions;
  int (*residual_count)(int n);
  Vector (*start)(int n);
  // r, and its Jacobian into *j unless null; *j is zero before.
  void (*evaluate)(const ConstVectorRef& x, VectorRef r, MatrixRef* j);
};

// Numbers 1 to 19, of one dimension each, and 20 to 35, of variable dimension.
const std::vector<MghFunction>& mgh_fixed_functions();
const std::vector<MghFunction>& mgh_variable_functions();

struct MghOptimum {
  std::optional<double> cost;
  std::vector<Vector> minimisers;  // the published one first
};

// What is known of the function `name` of n variables and m residuals.
MghOptimum mgh_optimum(std::string_view name, int n, int m);

}  // namespace odobench
