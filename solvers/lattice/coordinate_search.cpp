#include "solvers/lattice/coordinate_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "solvers/lattice/greedy_scan.hpp"

namespace odobench {

Matrix coordinate_neighbours(const Vector& u, double step) {
  const Eigen::Index m = u.size();
  Matrix all(m, 2 * m);
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < m; ++i) {
    for (const double sign : {1.0, -1.0}) {
      const double moved = std::clamp(u[i] + sign * step, -1.0, 1.0);
      if (moved == u[i]) continue;
      all.col(count) = u;
      all(i, count) = moved;
      ++count;
    }
  }
  return all.leftCols(count);
}

void CoordinateSearchOptions::bind(OptionBinder& binder) {
  binder.number("step", step, "first step, half-widths of the box", 1e-15, 2);
  binder.number("tolerance", tolerance, "stop when the step is below this", 1e-15, 2);
  binder.integer("moves", moves, "limit of moves", 1);
  binder.flag("lattice", lattice, "stay on the problem's lattice of admissible values, if it has one");
}

void CoordinateSearchOptions::validate() const {
  if (tolerance > step)
    throw std::invalid_argument(fmt::format(
        "solver 'coordinate': option tolerance={} > step={}; expected tolerance <= step", tolerance, step));
}

Outcome CoordinateSearch::minimise_on_lattice(Run& run) const {
  const std::vector<Vector>& levels = run.problem().lattice_levels();
  const std::unique_ptr<LatticePoint> point = run.lattice_point();
  run.cost(run.box().to_unit(point->x()));
  for (int moves = 0;; ++moves) {
    Eigen::Index choice = -1;
    double best = 0, best_level = 0;
    for (Eigen::Index i = 0; i < point->x().size(); ++i) {
      const Vector& of_i = levels[static_cast<std::size_t>(i)];
      for (Eigen::Index l = of_i.size() - 1; l >= 0; --l) {
        if (of_i[l] == point->x()[i]) continue;
        const double change = run.lattice_change(*point, i, of_i[l]);
        if (!(change < best)) continue;
        best = change;
        best_level = of_i[l];
        choice = i;
      }
    }
    if (run.stop()) return {};
    run.iteration();
    if (choice < 0)
      return {Termination::Settled,
              fmt::format("no change of one parameter lowers the cost, {} scans", moves + 1), true};
    if (moves == options_.moves)
      return {Termination::IterationLimit, fmt::format("{} moves >= limit {}", moves, options_.moves), true};
    point->move(choice, best_level);
    run.lattice_visit(*point);
  }
}

Outcome CoordinateSearch::minimise(Run& run) const {
  if (options_.lattice && run.problem().has_lattice()) return minimise_on_lattice(run);
  Vector u = run.start();
  double cost = run.cost(u);
  int moves_left = options_.moves;
  double step = options_.step;
  for (; step >= options_.tolerance; step *= 0.5) {
    const ScanEnd end = greedy_scan(
        run, [step](const Vector& at) { return coordinate_neighbours(at, step); }, u, cost, moves_left);
    if (end == ScanEnd::RunStopped) return {};
    if (end == ScanEnd::MoveLimit)
      return {Termination::IterationLimit,
              fmt::format("{} moves >= limit {}, step {:.2g}", options_.moves, options_.moves, step)};
  }
  return {Termination::Settled, fmt::format("step {:.2g} < {:.2g}", step, options_.tolerance)};
}

SolverEntry coordinate_search_entry() {
  return make_entry<CoordinateSearch, CoordinateSearchOptions>(
      "coordinate", "greedy coordinate search: on a lattice, or with step halving", false);
}

}  // namespace odobench
