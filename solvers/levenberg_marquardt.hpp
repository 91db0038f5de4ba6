// Levenberg-Marquardt for box-constrained least squares on the normal equations (J, J'r, J'J in one pass).
//
// Every step solves the damped quadratic model of the cost on the box exactly, in unit coordinates u:
//     min_d  r'r + 2 (J'r)'d + d'(J'J + lambda D) d    subject to  -1 <= u + d <= 1,   D = diag(J'J),
// by a primal active-set method. Clipping or projecting an unconstrained step instead stalls on this problem class
// (docs/solvers.md). lambda follows the gain ratio rho = actual / predicted decrease (Nielsen 1999).
// Stops when the projected gradient, relative to the cost, or the predicted decrease is below tolerance.
#pragma once

#include "solvers/solver.hpp"

namespace odobench {

struct LevenbergMarquardtOptions {
  double lambda = 1e-3;  // initial damping, relative to diag(J'J)
  double gradient_tolerance = 1e-10;
  double cost_tolerance = 1e-15;
  int iterations = 1000;
  void bind(OptionBinder& binder);
  void validate() const;
};

class LevenbergMarquardt final : public Solver {
 public:
  explicit LevenbergMarquardt(LevenbergMarquardtOptions options) : options_(options) {}
  std::string why_not(const Problem& problem) const override;
  Outcome minimise(Run& run) const override;

 private:
  LevenbergMarquardtOptions options_;
};

SolverEntry levenberg_marquardt_entry();

// min_d g'd + 1/2 d'H d subject to lower <= d <= upper, H symmetric positive definite (m x m), lower <= 0 <= upper.
// Primal active-set method; returns d with every multiplier of the right sign. At most 50 m changes of the set.
Vector solve_box_quadratic(const Matrix& h, const Vector& g, const Vector& lower, const Vector& upper);

}  // namespace odobench
