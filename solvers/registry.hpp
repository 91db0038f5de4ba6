// Every solver by name.
#pragma once

#include "solvers/solver.hpp"

namespace odobench {

// In the order of `bench list solvers`.
const std::vector<SolverEntry>& solver_registry();

// Throws std::invalid_argument "unknown solver 'x', did you mean 'y'?".
const SolverEntry& find_solver(const std::string& name);

}  // namespace odobench
