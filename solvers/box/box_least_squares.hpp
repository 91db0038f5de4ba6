// Linear least squares on a box.
#pragma once

#include "problems/problem.hpp"

namespace odobench {

// min_d |A d + b|^2 subject to lower <= d <= upper, A (k x m), lower <= 0 <= upper: the bounded-variable
// least squares of Stark and Parker (1995), started at d = 0. The free coordinates are found by a
// rank-revealing QR factorisation of their columns, so that A'A, which has half of A's digits, is never
// formed; columns that depend on others to 1e-14 stay.
Vector solve_box_least_squares(const Matrix& a, const Vector& b, const Vector& lower, const Vector& upper);

}  // namespace odobench
