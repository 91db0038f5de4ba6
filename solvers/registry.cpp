#include "solvers/registry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

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

void SolverTable::add(SolverEntry entry) {
  for (const SolverEntry& e : entries_)
    if (e.name == entry.name) throw std::logic_error(fmt::format("solver '{}' is added twice", entry.name));
  entries_.push_back(std::move(entry));
}

const SolverEntry& SolverTable::find(const std::string& name) const {
  const auto row =
      std::find_if(entries_.begin(), entries_.end(), [&](const SolverEntry& e) { return e.name == name; });
  if (row != entries_.end()) return *row;
  std::vector<std::string> names;
  for (const SolverEntry& e : entries_) names.push_back(e.name);
  throw std::invalid_argument(
      fmt::format("unknown solver '{}'{}; 'bench list solvers' shows all", name, did_you_mean(name, names)));
}

void add_known_solvers(SolverTable& table) {
  table.add(levenberg_marquardt_entry());
  table.add(ceres_entry());
  table.add(interior_point_entry());
  table.add(genetic_entry());
  table.add(particle_swarm_entry());
  table.add(cmaes_entry());
  table.add(differential_evolution_entry());
  table.add(multistart_entry(table));
  table.add(coordinate_search_entry());
  table.add(exact_search_entry());
  table.add(relaxed_search_entry());
  for (SolverEntry& entry : nlopt_entries()) table.add(std::move(entry));
}

const SolverTable& known_solvers() {
  static const SolverTable& table = []() -> const SolverTable& {
    static SolverTable known;
    add_known_solvers(known);
    return known;
  }();
  return table;
}

}  // namespace odobench
