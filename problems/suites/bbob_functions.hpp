// The 24 noiseless functions of BBOB (bbob.hpp): what an instance consists of, and its evaluation.
#pragma once

#include <array>

#include "problems/matrices.hpp"
#include "problems/problem.hpp"

namespace odobench {

inline constexpr int kBbobFunctions = 24;

// One function in n dimensions, shifted and rotated. f(x) = raw(x) + offset with raw(best) = 0.
struct BbobInstance {
  int function = 1;   // 1 .. 24
  Vector best;        // x_opt, where the lowest value is attained (n)
  double offset = 0;  // f_opt
  Matrix outer;       // what is applied first to x - x_opt, R or Q of the report (n x n); empty: nothing
  Matrix inner;       // what is applied after the nonlinear map (n x n); empty: nothing
  // Gallagher's peaks (f21, f22): places (n x peaks) in rotated coordinates, weights of the squares, heights.
  Matrix peaks, peak_weights;
  Vector heights;

  // Throws std::invalid_argument outside 1..24 and below two dimensions.
  static BbobInstance make(int function, int n, int instance);

  // Sum over the parameters outside [-5, 5] of their squared distance to it: what some functions add,
  // multiplied.
  static double outside(const ConstVectorRef& x);

  // f(x) without the offset.
  double raw(const ConstVectorRef& x) const;
  // The same and df/dx (n). Of the functions with has_gradient() only; elsewhere std::logic_error.
  double raw_and_gradient(const ConstVectorRef& x, VectorRef gradient) const;
  // Functions that are differentiable (but for isolated points) with a derivative as cheap as the value.
  static bool has_gradient(int function);
};

// "sphere", "separable ellipsoid", ...
const char* bbob_title(int function);
// What makes it hard, in a line.
const char* bbob_hardness(int function);

}  // namespace odobench
