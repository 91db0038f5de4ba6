// Greedy descent over a finite neighbourhood, whatever the neighbours are: steps along coordinates of a
// continuous box, or moves on a lattice.
#pragma once

#include <functional>

#include "solvers/run.hpp"

namespace odobench {

// The neighbours of u (m), one per column, in the order in which ties are decided; may be empty.
using Neighbourhood = std::function<Matrix(const Vector& u)>;

enum class ScanEnd { LocalMinimum, MoveLimit, RunStopped };

// Index of the smallest cost if that is below `incumbent`, the first one among equals; -1 if none is.
Eigen::Index greedy_choice(const Vector& costs, double incumbent);

// Evaluates all neighbours of u in one batch, moves to the best one if it is strictly better, and repeats
// until none is, or `moves_left`, counted down with every move, is used up. `u` and `cost`, the value at u,
// are updated.
ScanEnd greedy_scan(Run& run, const Neighbourhood& neighbourhood, Vector& u, double& cost, int& moves_left);

}  // namespace odobench
