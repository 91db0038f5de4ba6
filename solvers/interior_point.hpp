// Ipopt 3.11 (Waechter, Biegler 2006): primal-dual interior point on the unit box, exact first derivatives, Hessian of
//     hessian=corrected      2 (J'J + S), S a secant estimate of the second-order part: where residuals are large J'J
//                            alone underestimates the curvature (19 times along one direction of the calibration)
//                            and Ipopt takes ten times the evaluations
//     hessian=gauss-newton   2 J'J
//     hessian=lbfgs          limited-memory BFGS of Ipopt, `memory` pairs: a gradient is enough
// The bounds are not relaxed, so every point evaluated lies inside the box. Ipopt ends a little inside of
// active bounds; afterwards coordinates next to a bound that -g points to are put on it and the point is evaluated
// once more: the best of both counts. The cost is divided by its value at the start: its scale changes nothing.
//
// Ipopt tags its vectors with a global counter and MUMPS keeps global state: neither is safe in several threads. One
// mutex lets one run at a time into their code; evaluations happen outside it, so runs in parallel still share work.
#pragma once

#include "solvers/solver.hpp"

namespace odobench {

struct InteriorPointOptions {
  std::string hessian = "corrected";
  int memory = 20;
  std::string mu_strategy = "adaptive";
  std::string nlp_scaling = "none";
  double tolerance = 1e-9;
  int iterations = 3000;
  void bind(OptionBinder& binder);
  void validate() const {}
};

class InteriorPoint final : public Solver {
 public:
  explicit InteriorPoint(InteriorPointOptions options) : options_(std::move(options)) {}
  std::string why_not(const Problem& problem) const override;
  Outcome minimise(Run& run) const override;

 private:
  InteriorPointOptions options_;
};

SolverEntry interior_point_entry();

}  // namespace odobench
