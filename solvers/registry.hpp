// Solvers by name.
#pragma once

#include <string>
#include <vector>

#include "solvers/solver.hpp"

namespace odobench {

class SolverTable {
 public:
  SolverTable() = default;
  SolverTable(const SolverTable&) = delete;  // methods that run others look them up in their own table
  SolverTable& operator=(const SolverTable&) = delete;

  // Throws std::logic_error when there is one of this name.
  void add(SolverEntry entry);
  // In the order in which they were added.
  const std::vector<SolverEntry>& entries() const { return entries_; }
  // Valid until the next add(). Throws std::invalid_argument "unknown solver 'x', did you mean 'y'?".
  const SolverEntry& find(const std::string& name) const;

 private:
  std::vector<SolverEntry> entries_;
};

// Every solver of this room, in the order of `bench list solvers`. `table` outlives what its entries make.
void add_known_solvers(SolverTable& table);

// A table of these alone, for callers without one of their own.
const SolverTable& known_solvers();
inline const std::vector<SolverEntry>& solver_registry() {
  return known_solvers().entries();
}
inline const SolverEntry& find_solver(const std::string& name) {
  return known_solvers().find(name);
}

}  // namespace odobench
