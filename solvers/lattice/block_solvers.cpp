#include "solvers/lattice/block_solvers.hpp"

#include <fmt/format.h>

#include "solvers/box/box_quadratic.hpp"
#include "solvers/lattice/ternary_search.hpp"

namespace odobench {

std::string ExactSearch::why_not(const Problem& problem) const {
  if (problem.block_quadratic() == nullptr) return "needs a cost made of quadratic blocks";
  if (!problem.has_lattice()) return "needs a lattice of admissible values";
  const Eigen::Vector3d ternary(-1, 0, 1);
  for (std::size_t i = 0; i < problem.parameters().size(); ++i) {
    const Vector& levels = problem.lattice_levels()[i];
    if (levels.size() != 3 || levels != ternary)
      return fmt::format("needs the levels -1, 0, 1 of every parameter, '{}' has others",
                         problem.parameters()[i].name);
  }
  return {};
}

Outcome ExactSearch::minimise(Run& run) const {
  const std::unique_ptr<LatticePoint> start = run.lattice_point();
  run.cost(run.box().to_unit(start->x()));  // something to show if it is interrupted
  const BlockQuadratic& quadratic = *run.problem().block_quadratic();
  const auto search = ternary_branch_and_bound(quadratic.blocks, [&run] { return run.stop(); });
  const Vector g = quadratic.stacked_g();
  Vector t(g.size());
  const SearchResult found = search->minimise({g.data(), static_cast<std::size_t>(g.size())},
                                              {t.data(), static_cast<std::size_t>(t.size())});
  const bool proven = !run.stop();
  run.iteration();
  run.lattice_visit(*run.problem().lattice_point(quadratic.unstack(t)));
  if (!proven) return {};
  return {Termination::Settled,
          fmt::format("proven: no lattice point is lower, {} candidates", found.evaluations), true};
}

std::string RelaxedSearch::why_not(const Problem& problem) const {
  return problem.block_quadratic() == nullptr ? "needs a cost made of quadratic blocks" : "";
}

Outcome RelaxedSearch::minimise(Run& run) const {
  const BlockQuadratic& quadratic = *run.problem().block_quadratic();
  const std::vector<ParameterInfo>& parameters = run.problem().parameters();
  const Vector start = run.box().to_parameters(run.start());
  run.cost(run.start());
  Vector x = start;
  for (const QuadraticBlock& block : quadratic.blocks) {
    const auto size = block.g.size();
    Vector at(size), lower(size), upper(size);
    for (Eigen::Index i = 0; i < size; ++i) {
      const ParameterInfo& p = parameters[static_cast<std::size_t>(block.index[static_cast<std::size_t>(i)])];
      at[i] = start[block.index[static_cast<std::size_t>(i)]];
      lower[i] = p.lower - at[i];
      upper[i] = p.upper - at[i];
    }
    const Vector d = solve_box_quadratic(2.0 * block.q, 2.0 * (block.q * at) - block.g, lower, upper);
    for (Eigen::Index i = 0; i < size; ++i) x[block.index[static_cast<std::size_t>(i)]] = at[i] + d[i];
  }
  run.iteration();
  run.cost(run.box().to_unit(x));
  if (run.stop()) return {};
  return {Termination::Settled,
          fmt::format("{} box-constrained quadratic blocks solved", quadratic.blocks.size())};
}

SolverEntry exact_search_entry() {
  return make_entry<ExactSearch, NoOptions>("exact", "lattice optimum of quadratic blocks, proven", false);
}

SolverEntry relaxed_search_entry() {
  return make_entry<RelaxedSearch, NoOptions>("relaxed", "optimum of quadratic blocks on the whole box",
                                              false);
}

}  // namespace odobench
