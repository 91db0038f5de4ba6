// Ceres 2.1 (Agarwal, Mierle and others): trust region with bounds, on box-constrained least squares J = r'r,
// in unit coordinates u in [-1, 1]^m.
//
// Ceres alone stalls on ill-conditioned problems with active bounds: it projects a step of the unconstrained
// model on the box and searches along the projection, which says CONVERGENCE far from a minimum. An outer
// active-set loop repairs that (active_set=true): a parameter that arrives at a bound with -g pointing out is
// held constant, Ceres works on the others, and when it has finished, bounds whose multiplier has the wrong
// sign are released, until the KKT conditions hold. active_set=false is Ceres as it comes.
//
// Ceres wants residuals, not normal equations. residuals=compressed hands it m + 1 of them per point, R (m +
// 1 x m)
// and s (m + 1) with  R'R = J'J,  R's = J'r,  s's = r'r:  the pivoted Cholesky factor of the Gram matrix of
// [J, r]; every quantity of a trust-region step is the same. Where the problem has residuals and no normal
// equations of its own, the factor comes from a QR factorisation of [J, r], which keeps the digits that J'J
// loses. residuals=full hands it all rows (residual_count x m, dense).
#pragma once

#include "solvers/solver.hpp"

namespace odobench {

struct CeresOptions {
  std::string strategy = "lm";
  bool active_set = true;
  std::string residuals = "compressed";
  double radius = 1e3;
  double gradient_tolerance = 1e-10;
  double cost_tolerance = 1e-16;
  int iterations = 1000;
  int round_iterations = 300;
  void bind(OptionBinder& binder);
  void validate() const {}
};

class CeresSolver final : public Solver {
 public:
  explicit CeresSolver(CeresOptions options) : options_(std::move(options)) {}
  std::string why_not(const Problem& problem) const override;
  Outcome minimise(Run& run) const override;

 private:
  CeresOptions options_;
};

SolverEntry ceres_entry();

// The compressions above, from r (k) and J (k x m) themselves:
void compress_residuals(const Matrix& j, const Vector& r, Matrix& jacobian, Vector& residuals);
// and from their products: fills R (m + 1 x m) and s (m + 1) for J'J (m x m, positive semidefinite), J'r (m)
// and r'r >= 0. Directions in which the Gram matrix is indefinite by rounding count as zero.
void compress_residuals(const NormalEquations& e, Matrix& jacobian, Vector& residuals);

}  // namespace odobench
