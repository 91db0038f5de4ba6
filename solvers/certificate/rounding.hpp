// How much of a least-squares cost rounding alone explains.
#pragma once

#include "problems/problem.hpp"
#include "solvers/box/box.hpp"

namespace odobench {

// As a part of the cost J(u) = r'r: the square of what the residuals change by when every parameter moves by
// two units in its last place. `length`: |J_i| / |r| in unit coordinates.
double resolution_part_of_cost(const Box& box, const Vector& u, const Vector& length);

// The larger of that and what the problem itself states (Problem::rounding_floor).
double rounding_part_of_cost(const Problem& problem, const Box& box, const Vector& u, const Vector& length,
                             double cost);

}  // namespace odobench
