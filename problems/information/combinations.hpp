// Combinations of parameters in words.
#pragma once

#include <string>
#include <vector>

#include "problems/problem.hpp"

namespace odobench {

// |nominal| of each parameter, or half its box where that is 0: what relative parameters q = z / scale are
// relative to.
Vector relative_scales(const std::vector<ParameterInfo>& parameters);

// The same space (columns of `basis`, n x k, independent) with few entries per column: reduced column echelon
// form with complete pivoting, largest entry of each column 1.
Matrix sparse_basis(Matrix basis);

// "a1, a3 against a2": one side larger in size, the other smaller; "r alone", "r1, r2 together" where there
// is one side. `q`: relative; entries below a twentieth of the largest, which is 1, are left out.
std::string combination_words(const Vector& q, const std::vector<ParameterInfo>& parameters);

}  // namespace odobench
