// Differential evolution with the memory of its own successes and a shrinking population: L-SHADE of R.
// Tanabe and A. Fukunaga (IEEE CEC 2014), its crossover in the frame of the population (S.-M. Guo and C.-C.
// Yang, IEEE Trans. Evol. Comput. 19, 2015).
//
// Every individual x of the population (N of them, m coordinates) makes a trial
//     v = x + F (p - x) + F (a - b)                                          (D1) current-to-pbest/1
// p: one of the best max(2, `greed` N), a: another individual, b: another one or one of the archive. With
// probability `frame` the crossover of v with x is done in the coordinates of the eigenvectors B of the
// covariance of the better half, else in those of the box:
//     t = B c,   c_i = (B'v)_i if u_i < CR or i = j, else (B'x)_i            (D2) u_i uniform, j drawn
// A trial no worse than x takes its place; a better one sends x into the archive (at most `archive` N, a
// random one leaves). F is drawn from a Cauchy, CR from a normal distribution of width 0.1 around one of
// `memory` places that hold weighted means (Lehmer means, weights: the gains) of the values that succeeded,
// one place renewed a generation.
//     N = N_0 + (4 - N_0) e / E                                              (D3) e of E evaluations made
// x lives in the coordinates of solvers/box/boundary_map.hpp; a coordinate that leaves them goes half the way
// back to the parent's.
#pragma once

#include "solvers/solver.hpp"

namespace odobench {

struct DifferentialEvolutionOptions {
  int population = 0;   // N_0, 0: 18 m
  int evaluations = 0;  // E, 0: 2400 m, or the run's budget where that is less
  int memory = 6;
  double greed = 0.11;
  double archive = 2.6;
  double frame = 0.8;
  double cost_tolerance = 1e-12;
  double boundary = 0.01;
  void bind(OptionBinder& binder);
  void validate() const {}
};

class DifferentialEvolution final : public Solver {
 public:
  explicit DifferentialEvolution(DifferentialEvolutionOptions options) : options_(options) {}
  std::string why_not(const Problem&) const override { return {}; }
  Outcome minimise(Run& run) const override;

 private:
  DifferentialEvolutionOptions options_;
};

SolverEntry differential_evolution_entry();

}  // namespace odobench
