// The nonlinear maps of the BBOB report, section 0.2, with their derivatives.
#pragma once

#include <cmath>

#include "problems/matrices.hpp"

namespace odobench::bbob {

// A number and its derivative.
struct Slope {
  double value = 0;
  double derivative = 0;
};

// T_osz: sign(x) exp(h + 0.049 (sin(c1 h) + sin(c2 h))), h = log|x|; c = 10, 7.9 above zero, 5.5, 3.1 below.
// At zero the derivative does not exist; it is given as 1, and only ever multiplied by zero.
inline Slope oscillate(double x) {
  if (x == 0) return {0, 1};
  const double h = std::log(std::abs(x)), c1 = x > 0 ? 10 : 5.5, c2 = x > 0 ? 7.9 : 3.1;
  const double size = std::exp(h + 0.049 * (std::sin(c1 * h) + std::sin(c2 * h)));
  return {std::copysign(size, x),
          size / std::abs(x) * (1 + 0.049 * (c1 * std::cos(c1 * h) + c2 * std::cos(c2 * h)))};
}

// (i - 1) / (n - 1) of the report, i from zero here.
inline double share(Eigen::Index i, Eigen::Index n) {
  return static_cast<double>(i) / static_cast<double>(n - 1);
}

// T_asy: x^(1 + beta share sqrt(x)) above zero, x itself below.
inline Slope asymmetric(double x, double beta, double share) {
  if (x <= 0) return {x, 1};
  const double root = std::sqrt(x), power = 1 + beta * share * root;
  const double value = std::pow(x, power);
  return {value, value * (power / x + beta * share * std::log(x) / (2 * root))};
}

// The diagonal of Lambda^alpha: alpha^(share / 2) (n).
inline Vector stretches(double alpha, Eigen::Index n) {
  Vector d(n);
  for (Eigen::Index i = 0; i < n; ++i) d[i] = std::pow(std::sqrt(alpha), share(i, n));
  return d;
}

}  // namespace odobench::bbob
