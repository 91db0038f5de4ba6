// How far a point of the unit box is from the first-order (KKT) conditions. Components of the gradient that
// point out of the box at a bound (u = -1 or 1 exactly) are no descent and are dropped.
#pragma once

#include "problems/problem.hpp"

namespace odobench {

// Held by the bound it lies on: moving along -g would leave the box.
inline bool held_by_bound(double u, double gradient) {
  return (u <= -1.0 && gradient > 0) || (u >= 1.0 && gradient < 0);
}

// max over free i of |J'r|_i / (|J_i| |r|), the cosine between the residual and a column of the Jacobian: in
// [0, 1], free of units and of the scale of the cost. 0 when the residual is.
double projected_cosine(const ConstVectorRef& u, const NormalEquations& e);

// max over free i of |g_i|, g the gradient of the cost in unit coordinates.
double projected_gradient(const ConstVectorRef& u, const ConstVectorRef& g);

// u with the coordinates that lie within `distance` of a bound put on it where -g points there.
Vector put_on_bounds(const Vector& u, const ConstVectorRef& gradient, double distance);

}  // namespace odobench
