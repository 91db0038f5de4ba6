// Two solvers for costs made of independent quadratic blocks (problems/block_quadratic.hpp): between them
// they say how far any other method is from the best there is.
#pragma once

#include "solvers/solver.hpp"

namespace odobench {

struct NoOptions {
  void bind(OptionBinder&) {}
  void validate() const {}
};

// The optimum over the lattice {-1, 0, 1}^n, proven (solvers/lattice/ternary_search.hpp).
class ExactSearch final : public Solver {
 public:
  explicit ExactSearch(NoOptions) {}
  // Needs the block form and the lattice {-1, 0, 1} of every parameter.
  std::string why_not(const Problem& problem) const override;
  Outcome minimise(Run& run) const override;
};

// The optimum over the whole box: the lower bound of everything on a lattice inside it.
class RelaxedSearch final : public Solver {
 public:
  explicit RelaxedSearch(NoOptions) {}
  std::string why_not(const Problem& problem) const override;
  Outcome minimise(Run& run) const override;
};

SolverEntry exact_search_entry();
SolverEntry relaxed_search_entry();

}  // namespace odobench
