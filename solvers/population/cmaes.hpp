// CMA-ES with box constraints and restarts: CmaDescent (solvers/population/cma_core.hpp) behind the map of
// solvers/box/boundary_map.hpp, so that the optimum may lie on any number of bounds.
//
// The first descent begins at the start of the run. A descent that has ended is followed by another one from
// a point drawn uniformly from the box,
//   ipop   with a doubled population (Auger and Hansen, CEC 2005), or
//   bipop  by turns with a doubled one and with a small one,
//          lambda = lambda_0 (lambda_large / (2 lambda_0))^(U^2), sigma = sigma_0 10^(-2U), U uniform,
//          whichever regime has spent fewer evaluations (Hansen, GECCO 2009),
// until the restarts with a doubled population are used up or a descent arrives at the best point again: the
// costs agree within 1e-9 of the larger of |J| and the improvement since the descent's first generation, the
// points within 0.05.
#pragma once

#include "solvers/solver.hpp"

namespace odobench {

struct CmaesOptions {
  int population = 0;  // lambda of the first descent, 0: 4 + 5 ln m
  double sigma = 0.2;  // first step, half-widths of the box
  bool active = true;  // negative weights for the worse half
  std::string strategy = "ipop";
  int restarts = 9;
  int generations = 0;  // per descent, 0: 100 + 50 (m + 3)^2 / sqrt(lambda)
  double cost_tolerance = 1e-12;
  double step_tolerance = 1e-11;
  double boundary = 0.01;  // width of the bent zone of the boundary map
  void bind(OptionBinder& binder);
  void validate() const;
};

class Cmaes final : public Solver {
 public:
  explicit Cmaes(CmaesOptions options) : options_(std::move(options)) {}
  std::string why_not(const Problem& problem) const override;
  Outcome minimise(Run& run) const override;

 private:
  CmaesOptions options_;
};

SolverEntry cmaes_entry();

}  // namespace odobench
