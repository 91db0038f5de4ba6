// Small test functions with known optima, for the conformance tests and for comparing methods without data.
//   sphere      J = sum (x_i - 1/3)^2                                        box [-1, 1]^n
//   ellipsoid   J = |D Q (x - c)|^2, D_i = 10^(3 (i-1)/(n-1)), Q a fixed rotation: a rotated valley of condition 1e6
//   corner      the ellipsoid with c outside the box: the optimum lies on bounds (no closed form: optimum not stated)
//   rosenbrock  J = sum 100 (x_{i+1} - x_i^2)^2 + (1 - x_i)^2 (Rosenbrock 1960), box [-2, 2]^n
//   powell      Powell's singular function (1962), n = 4, box [-4, 5]^4: J'J singular at the optimum
//   rastrigin   J = sum x_i^2 - 10 cos(2 pi x_i) + 10, box [-5.12, 4.12]^n: many local minima, gradient only
//   step        J = sum floor(|4 x_i|): piecewise constant, no derivatives
// All parameters are dimensionless.
#pragma once

#include <string>
#include <vector>

#include "problems/problem.hpp"

namespace odobench {

// Names as above. Throws std::invalid_argument on an unknown name or a dimension < 2 (powell: != 4).
Problem make_classic_problem(const std::string& name, int dimension);
const std::vector<std::string>& classic_problem_names();

}  // namespace odobench
