// Greedy coordinate search with step halving. From u all 2 m neighbours u +- step e_i are evaluated in one
// batch; the search moves to the best of them if it is better than u (the first one among equals, in the
// order +e_1, -e_1, +e_2, ...), else the step is halved, until it is below `tolerance`. A neighbour beyond
// the box is put on the bound; one that this would leave at u is not evaluated. Deterministic, needs no
// derivatives, survives plateaus and non-finite costs, and crawls in a rotated valley: it is the baseline of
// the others (a compass search: Kolda, Lewis, Torczon, SIAM Review 45, 2003).
// On a problem with a lattice of admissible values it walks there instead, from the admissible point nearest
// to the start: a scan looks at every change of one parameter to another of its levels, and makes the best
// one. The first among equals wins, in the order of the parameters and, within one, from the highest level
// down (T. Stirblys, Kaunas
// 2015, section 2.2.2, for the levels -1, 0, 1). Iterations count the scans, the last and unsuccessful one
// included.
#pragma once

#include "solvers/solver.hpp"

namespace odobench {

struct CoordinateSearchOptions {
  double step = 0.5;  // half-widths of the box
  double tolerance = 1e-9;
  int moves = 5000;
  bool lattice = true;
  void bind(OptionBinder& binder);
  void validate() const;
};

class CoordinateSearch final : public Solver {
 public:
  explicit CoordinateSearch(CoordinateSearchOptions options) : options_(options) {}
  std::string why_not(const Problem&) const override { return {}; }
  Outcome minimise(Run& run) const override;

 private:
  Outcome minimise_on_lattice(Run& run) const;
  CoordinateSearchOptions options_;
};

SolverEntry coordinate_search_entry();

// The neighbours described above, in that order: m x (up to 2 m).
Matrix coordinate_neighbours(const Vector& u, double step);

}  // namespace odobench
