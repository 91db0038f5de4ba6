// Genetic algorithms on the box.
//
// variant=modern (default): real-coded, with a multi-parent recombination that does not depend on the
// coordinate frame. Population P of points y in R^m behind the map of solvers/box/boundary_map.hpp. Every
// generation:
//     n_p parents y_1 .. y_{n_p}, in the order of their costs, are drawn from P without replacement;
//     n_c children  y = c + alpha sum_j xi_j (y_j - mean y_j) / sqrt(n_p),  xi_j ~ N(0, 1) i.i.d.         (R)
//     c = sum_j w_j y_j,  w_j ~ ln(n_p + 1) - ln j, normalised (weights = false: the mean)                (C)
//     the n_p best children take the places of the parents; only the best member of P survives besides
//     (elitist = true: the n_p best of parents and children do)
//     alpha <- alpha exp(0.02 (rho - 1.1)) in [0.8, 1.5],  rho = |s|^2 n / (n_p - 1),
//              s = mean of the xi of the n = n_c / 4 best children: rho is 1 on average by chance,
//              above it while the good children lie to one side                                           (E)
// (R) is the real-coded ensemble crossover REX of Kobayashi (Trans. JSAI 24, 2009), the replacement the just
// generation gap of Akimoto, Sakuma, Ono and Kobayashi; a centre towards the better parents and an adapted
// expansion rate are ideas of their REX-star and AREX, (C) and (E) are ours. The children have the parents'
// covariance, whatever its shape: no step depends on the coordinate frame, a rotated valley is as easy as a
// sphere once the population lies in it.
//
// variant=thesis: the program of J. Vitko's thesis (Zagreb 2024), see solvers/population/genetic_thesis.hpp.
#pragma once

#include "solvers/solver.hpp"

namespace odobench {

struct GeneticOptions {
  std::string variant = "modern";
  int population = 0;   // 0: modern 5 m, at least 20, thesis 12
  int generations = 0;  // 0: modern 20000, thesis 600
  // modern
  int parents = 0;   // 0: 2 m, at least 8
  int children = 0;  // 0: 6 m, at least 12
  double expansion = 1.0;
  bool adapt = true;
  bool weights = true;
  bool elitist = false;
  double cost_tolerance = 1e-12;
  double boundary = 0.01;
  // thesis
  double pc = 0.75, pm = 0.06;
  int crossover = 1;
  double factor_low = 0.95, factor_high = 1.05;
  double eta = 5;
  void bind(OptionBinder& binder);
  void validate() const;
};

class Genetic final : public Solver {
 public:
  explicit Genetic(GeneticOptions options) : options_(std::move(options)) {}
  std::string why_not(const Problem&) const override { return {}; }
  Outcome minimise(Run& run) const override;

 private:
  Outcome modern(Run& run) const;
  GeneticOptions options_;
};

SolverEntry genetic_entry();

}  // namespace odobench
