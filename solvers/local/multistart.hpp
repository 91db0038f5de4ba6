// A local method from many starts: how many optima there are, how often each is found, and which is the
// lowest.
//
// The first start is that of the run; the others are spread over the box,
//   sobol  points of the Sobol sequence, shifted by one random vector modulo the box (Cranley and Patterson,
//          SIAM J. Numer. Anal. 13, 1976): any number of them is spread evenly;
//   lhs    a Latin hypercube of all of them (McKay, Beckman and Conover, Technometrics 21, 1979).
// Two searches ended in the same optimum when no parameter differs by more than 1e-3 of half its box and the
// costs agree within 1e-6 (of the larger one, with 1e-12 of the first cost as a floor).
//
// `effort` keeps the price of certainty in proportion: no further start once `effort` times the evaluations
// that it took to find the lowest optimum are spent without a lower one (by 1e-9); the search that crosses
// that line is broken off. Where the first search does not end by itself there is no such line. effort=0 uses
// every start.
#pragma once

#include "solvers/registry.hpp"
#include "solvers/solver.hpp"

namespace odobench {

struct MultistartOptions {
  const SolverTable* known = nullptr;  // null: known_solvers()
  std::string solver = "lm";
  int starts = 20;
  std::string sampling = "sobol";
  double effort = 3;
  void bind(OptionBinder& binder);
  // The inner method is known, takes its options and is none of several starts.
  void validate() const;
};

class Multistart final : public Solver {
 public:
  explicit Multistart(MultistartOptions options);
  std::string why_not(const Problem& problem) const override;
  Outcome minimise(Run& run) const override;

 private:
  MultistartOptions options_;
  std::unique_ptr<Solver> inner_;
};

// `known`: where the local method is looked up; outlives what the entry makes.
SolverEntry multistart_entry(const SolverTable& known);

// m x n points in [-1, 1]^m, one per column.
Matrix sobol_starts(Eigen::Index m, Eigen::Index n, Random& random);
Matrix latin_hypercube(Eigen::Index m, Eigen::Index n, Random& random);

}  // namespace odobench
