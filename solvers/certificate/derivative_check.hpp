// Derivatives that a problem states against differences of its own values.
//
// The reference is Ridders' method (C. J. F. Ridders, "Accurate computation of F'(x) and F'(x) F''(x)",
// Advances in Engineering Software 4(2), 1982): central differences with steps that shrink by 4, extrapolated
// to the step zero; the entry of the tableau whose neighbours agree best is taken, and how far they are apart
// is its error. Where x_i lies on a bound (or too near to it for the first step) differences are one-sided,
// away from the bound, and extrapolated in powers of the step instead of its square. Steps begin at 1/100 of
// max(|x_i|, 1e-4 of the box's width).
#pragma once

#include <string>
#include <vector>

#include "problems/problem.hpp"

namespace odobench {

// One kind of derivative of one parameter at one point.
struct DerivativeComparison {
  std::string kind;       // "Jacobian", "gradient", "J'J"
  std::string parameter;  // name
  // |stated - differenced| of the worst entry, as a part of the largest entry of the column (Jacobian), of
  // the component (gradient), or of |J_i| |J_k| (J'J, against the product of the Jacobian with itself).
  // Not-a-number where what is stated is not finite though the problem is finite around the point.
  double error = 0;
  // What error may be: 1e-6 (J'J: 1e-9), or ten times the uncertainty of the differences where that is more.
  double limit = 0;
  double stated = 0, differenced = 0;  // the worst entry
  Eigen::Index row = 0;                // of the Jacobian, counted from 0; of J'J the other parameter

  bool agrees() const { return error <= limit; }
  // The differences are too uncertain to tell a wrong derivative from a right one.
  bool undecided() const { return limit > 0.1; }
};

// d r / d x by differences alone, residual_count() x n; columns of parameters held fixed are zero. Empty
// where the problem has no residuals, or the differences of a column are uncertain by more than 1e-4 of it.
Matrix difference_jacobian(const Problem& problem, const ConstVectorRef& x);

// Every free parameter (lower < upper) in every kind that the problem has: the Jacobian of the residuals, the
// gradient of the cost (2 J'r where there is no gradient of its own), J'J where the problem forms its own.
// Empty without derivatives and where the cost at x is not finite. The evaluations are counted on `problem`.
std::vector<DerivativeComparison> compare_derivatives(const Problem& problem, const ConstVectorRef& x);

}  // namespace odobench
