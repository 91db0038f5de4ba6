// The algorithms of NLopt 2.7.1 (S. G. Johnson) that apply to a box without other constraints, as nlopt:NAME.
//
// They see unit coordinates u in [-1, 1]^m and the cost divided by its value where they start, so that
// neither the units of the parameters nor the scale of the cost matters (SLSQP stops at once on the raw
// calibration cost). A point whose cost or gradient is not finite gets a finite cost above every cost seen.
// Budget, clock and interruption are the driver's.
//
// A local method that stops is started again from the best point, with the cost there as the new unit, while
// that gains more than restart_gain of the cost and the projected gradient is above gradient_tolerance of the
// present cost, at most `restarts` times. NLopt's tolerances do not show optimality: what may be said of the
// end is the driver's business.
//
// Random numbers: NLopt's generator is thread-local since 2.4 and is seeded here from the run's engine before
// it starts, on the thread that the run stays on: same seed, same bits, in any number of threads. StoGO and
// AGS have static variables besides; one mutex lets one run of them at a time through, evaluations included.
//
// NEWUOA knows no bounds: it works on coordinates that fold onto the box (solvers/box/boundary_map.hpp).
// NLopt's bounded variant is left out, since its subproblem cannot be interrupted and may not return.
//
// What cannot be cured from outside: StoGO calls exit() when a denominator of its local search is exactly
// zero (not seen in 400 runs on the classic problems and on functions of one variable).
#pragma once

#include "solvers/solver.hpp"

namespace odobench {

struct NloptAlgorithm;  // a row of the table in nlopt_algorithms.hpp

struct NloptOptions {
  const NloptAlgorithm* algorithm = nullptr;
  double xtol = 1e-10;
  double ftol = 1e-14;
  double gradient_tolerance = 1e-8;
  double restart_gain = 1e-8;
  double step = -1;  // -1: NLopt's choice
  int population = 0;
  int memory = 0;
  int restarts = 3;
  int evaluations = 100000;
  std::string local = "lbfgs";
  double local_xtol = 1e-8;
  void bind(OptionBinder& binder);
  void validate() const {}
};

class NloptSolver final : public Solver {
 public:
  explicit NloptSolver(NloptOptions options) : options_(std::move(options)) {}
  std::string why_not(const Problem& problem) const override;
  Outcome minimise(Run& run) const override;

 private:
  NloptOptions options_;
};

// One entry per algorithm.
std::vector<SolverEntry> nlopt_entries();

}  // namespace odobench
