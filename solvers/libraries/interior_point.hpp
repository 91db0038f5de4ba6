// Ipopt 3.11 (Waechter, Biegler 2006): primal-dual interior point on the unit box, exact first derivatives,
// Hessian of
//     hessian=corrected      2 (J'J + S), S a secant estimate of the second-order part: where residuals are
//     large J'J
//                            alone underestimates the curvature (19 times along one direction of the
//                            calibration) and Ipopt takes ten times the evaluations
//     hessian=gauss-newton   2 J'J
//     hessian=lbfgs          limited-memory BFGS of Ipopt, `memory` pairs: a gradient is enough
// The bounds are not relaxed, so every point evaluated lies inside the box. Ipopt ends a little inside of
// active bounds; afterwards coordinates next to a bound that -g points to are put on it and the point is
// evaluated once more: the best of both counts. The cost is divided by its value where Ipopt starts: its
// scale changes nothing.
//
// Ipopt's tolerance is relative to that value, which says little where the cost falls by ten decades. While a
// bounded Gauss-Newton step from the end (one evaluation) promises more than restart_gain of the present
// cost, Ipopt is started there again with that cost as unit, a small barrier and without being pushed away
// from the bounds.
//
// What a run costs: MUMPS 5.5 computes the size of a saved instance of itself in every call, 60 % of all
// instructions of a run of a dozen parameters; there is no other linear solver in Debian's Ipopt. Iterative
// refinement, which doubles the calls, is left to where the residual asks for it.
//
// Ipopt tags its vectors with a global counter and MUMPS keeps global state: neither is safe in several
// threads. One mutex lets one run at a time into their code; evaluations happen outside it, so runs in
// parallel still share work.
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
  int restarts = 10;
  double restart_gain = 1e-9;
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
