#include "solvers/registry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "base/names.hpp"
#include "solvers/lattice/block_solvers.hpp"
#include "solvers/lattice/coordinate_search.hpp"
#include "solvers/libraries/ceres_solver.hpp"
#include "solvers/libraries/interior_point.hpp"
#include "solvers/libraries/nlopt_solvers.hpp"
#include "solvers/local/levenberg_marquardt.hpp"
#include "solvers/local/multistart.hpp"
#include "solvers/population/cmaes.hpp"
#include "solvers/population/differential_evolution.hpp"
#include "solvers/population/genetic.hpp"
#include "solvers/population/particle_swarm.hpp"

namespace odobench {

const std::vector<SolverEntry>& solver_registry() {
  static const std::vector<SolverEntry> registry = [] {
    std::vector<SolverEntry> rows;
    rows.push_back(levenberg_marquardt_entry());
    rows.push_back(ceres_entry());
    rows.push_back(interior_point_entry());
    rows.push_back(genetic_entry());
    rows.push_back(particle_swarm_entry());
    rows.push_back(cmaes_entry());
    rows.push_back(differential_evolution_entry());
    rows.push_back(multistart_entry());
    rows.push_back(coordinate_search_entry());
    rows.push_back(exact_search_entry());
    rows.push_back(relaxed_search_entry());
    for (SolverEntry& entry : nlopt_entries()) rows.push_back(std::move(entry));
    return rows;
  }();
  return registry;
}

const SolverEntry& find_solver(const std::string& name) {
  const auto& rows = solver_registry();
  const auto row =
      std::find_if(rows.begin(), rows.end(), [&](const SolverEntry& e) { return e.name == name; });
  if (row != rows.end()) return *row;
  std::vector<std::string> names;
  for (const SolverEntry& e : rows) names.push_back(e.name);
  throw std::invalid_argument(
      fmt::format("unknown solver '{}'{}; 'bench list solvers' shows all", name, did_you_mean(name, names)));
}

}  // namespace odobench
