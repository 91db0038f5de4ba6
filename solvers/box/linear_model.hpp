// Derivatives of a least-squares cost at a point in a form that neither the units of the parameters nor a
// factor on the residuals can bring out of the range or the digits of doubles.
#pragma once

#include "problems/problem.hpp"

namespace odobench {

// The linear model of the residuals around u, in units of their norm:  r(u + d)/|r(u)| = b + A S d,  S =
// diag(size), with orthogonal transformations applied from the left, so that only lengths and angles are
// kept:
//     A'A = correlations of the columns of J (unit diagonal; a zero column stays zero),  A'b = their cosines
//     with r,
//     |b| <= 1: the part of r that the columns can reach,  size_i = |J_i| / |r|.
struct LinearModel {
  double cost = 0;
  Matrix a;                // k x m
  Vector b;                // k
  Vector size;             // m
  bool truncated = false;  // directions were dropped that J'J in doubles cannot resolve
};

// From J = r'r, J'r, J'J (in any coordinates): A and b from the eigenvalues of the equilibrated J'J; those
// below
// 1e-13 m of the largest are rounding and are dropped. cost > 0 and all finite.
LinearModel linear_model(const NormalEquations& e);

// From r and J themselves, by a QR factorisation: keeps the digits that J'J loses. r not zero, all finite.
LinearModel linear_model(const ConstVectorRef& r, const ConstMatrixRef& j);

// What the best step d inside lower <= d <= upper (m) gains in the model, as a part of the cost: in [0, 1].
double promised_gain(const LinearModel& model, const Vector& lower, const Vector& upper);

}  // namespace odobench
