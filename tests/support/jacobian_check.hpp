// Residuals and Jacobian of a problem against a reference in long double.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "problems/problem.hpp"

namespace odobench::testing {

using LongResiduals = std::function<std::vector<long double>(const std::vector<long double>& x)>;

struct JacobianErrors {
  double residual = 0;  // largest |r - reference| / max(1, largest |reference|)
  double jacobian = 0;  // largest |J_ij - reference| / largest |reference| of the column, beyond rounding
};

// Derivatives of the reference by the five-point formula with steps of 1e-5 max(|x_j|, scale): in long double
// its own error is about 1e-11 of the column at most for the problems
// here. What rounding r_i in long double does to a difference is allowed for, entry by entry.
inline JacobianErrors compare_jacobian(const Problem& problem, const Vector& x,
                                       const LongResiduals& reference, long double scale) {
  const Eigen::Index m = problem.residual_count(), n = x.size();
  Vector r(m);
  Matrix j(m, n);
  problem.residuals_and_jacobian(x, r, j);
  Vector alone(m);
  problem.residuals(x, alone);
  EXPECT_EQ((r - alone).cwiseAbs().maxCoeff(), 0)
      << problem.name() << ": residuals() and with Jacobian differ";
  EXPECT_EQ(problem.cost(x), r.squaredNorm()) << problem.name();

  const std::vector<long double> at(x.begin(), x.end());
  const std::vector<long double> expected = reference(at);
  EXPECT_EQ(static_cast<Eigen::Index>(expected.size()), m) << problem.name();
  JacobianErrors errors;
  long double size = 1, error = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    size = std::max(size, std::abs(expected[i]));
    error = std::max(error, std::abs(r[static_cast<Eigen::Index>(i)] - expected[i]));
  }
  errors.residual = static_cast<double>(error / size);

  for (Eigen::Index k = 0; k < n; ++k) {
    const auto c = static_cast<std::size_t>(k);
    const long double h = 1e-5L * std::max(std::abs(at[c]), scale);
    const auto shifted = [&](int steps) {
      std::vector<long double> y = at;
      y[c] += static_cast<long double>(steps) * h;
      return reference(y);
    };
    const auto a = shifted(-2), b = shifted(-1), d = shifted(1), e = shifted(2);
    long double column = 0, difference = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const long double slope = (a[i] - e[i] + 8 * (d[i] - b[i])) / (12 * h);
      column = std::max(column, std::abs(slope));
      const long double rounding =
          8 * std::numeric_limits<long double>::epsilon() * std::max(1.0L, std::abs(expected[i])) / h;
      const long double apart = std::abs(j(static_cast<Eigen::Index>(i), k) - slope);
      if (!(apart <= rounding)) difference = std::max(difference, apart - rounding);
      if (!std::isfinite(apart)) difference = apart;
    }
    EXPECT_TRUE(std::isfinite(difference)) << problem.name() << ", parameter " << k + 1;
    if (column > 0)
      errors.jacobian = std::max(errors.jacobian, static_cast<double>(difference / column));
    else
      EXPECT_EQ(difference, 0) << problem.name() << ", parameter " << k + 1;
  }
  return errors;
}

// The start, three points up to 10 % (or 0.1 scale) from it, and the known minimisers.
inline std::vector<Vector> points_to_check(const Problem& problem, double scale) {
  std::vector<Vector> points = problem.known_minimisers();
  points.push_back(problem.start());
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-0.1, 0.1);
  for (int k = 0; k < 3; ++k) {
    Vector x = problem.start();
    for (double& value : x) value += unit(random) * std::max(std::abs(value), scale);
    points.push_back(x);
  }
  return points;
}

}  // namespace odobench::testing
