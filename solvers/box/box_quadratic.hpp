// Strictly convex quadratic functions on a box.
#pragma once

#include "problems/problem.hpp"

namespace odobench {

// min_d g'd + 1/2 d'H d subject to lower <= d <= upper, H symmetric positive definite (m x m), lower <= 0 <=
// upper. Returns d with every multiplier of the right sign. Small models are solved by a primal active-set
// method that changes one bound at a time; large ones find their set first by block principal pivoting
// (Judice, Pires 1994), which changes all wrong bounds at once and needs a few factorisations instead of one
// per bound.
Vector solve_box_quadratic(const Matrix& h, const Vector& g, const Vector& lower, const Vector& upper);

}  // namespace odobench
