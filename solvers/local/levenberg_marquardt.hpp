// Levenberg-Marquardt for box-constrained least squares.
//
// Every step solves the damped linear model of the residuals on the box exactly, in unit coordinates u:
//     min_d  |r + J d|^2 + lambda |D d|^2    subject to  -1 <= u + d <= 1.
// Clipping or projecting an unconstrained step instead stalls on this problem class (docs/solvers.md). D_i is
// the largest |J_i| met so far (More 1978): the scale of a parameter whose influence fades does not shrink
// with it, which is what keeps the step sensible far from the solution. lambda follows the gain ratio rho =
// actual / predicted decrease (Nielsen 1999).
//
// Problems that have normal equations of their own (one pass over long recordings) are solved on those; all
// others on a QR factor of J, since J'J has half the digits of J (NIST's Bennett5 and Lanczos problems need
// the others).
//
// The largest-column scale keeps some valleys from being entered (NIST's MGH10 from its first start crawls
// along a wrong one for thousands of steps), the scale of the box others. A path that has not ended after
// `patience` iterations, or that stalls, is set aside, a second one with D = 1 in unit coordinates takes as
// many from the start, and the lower of the two goes on.
//
// A point whose derivatives are not finite is a rejected step. The method ends when the projected gradient,
// relative to the cost, is below its tolerance; when the *undamped* model promises less than cost_tolerance
// of the cost, or no more than rounding explains (a large lambda alone makes any step small, a wrong Jacobian
// does too); or when lambda has grown out of all proportion.
#pragma once

#include "solvers/solver.hpp"

namespace odobench {

struct LevenbergMarquardtOptions {
  double lambda = 1e-3;  // initial damping, relative to D^2
  double gradient_tolerance = 1e-10;
  double cost_tolerance = 1e-15;
  int iterations = 1000;
  int patience = 300;
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

}  // namespace odobench
