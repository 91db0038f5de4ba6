// A smooth map from all of R^m onto the unit box, for sampling methods whose optimum may lie on bounds.
//
// Per coordinate, with width a of the bent zone; odd, and periodic with period 4 (1 + a) like a sine:
//     u(y) = y                                  |y| <= 1 - a
//     u(y) = 1 - (1 + a - y)^2 / (4 a)          1 - a < y <= 1 + a      (u' continuous, u'(1 + a) = 0)
//     u(y) = u(2 (1 + a) - y)                   beyond: the line is folded back
// (the idea is Hansen's, the boundary handler of the C code of CMA-ES, 2010). A linear slope of the cost
// towards a bound becomes a parabola with its minimum at y = 1 + a: an active bound looks to the method like
// any other smooth minimum, every sample is feasible, nothing is clamped, and an error dy costs only
// dy^2 / (4 a).
#pragma once

#include "problems/problem.hpp"

namespace odobench {

class BoundaryMap {
 public:
  // 0 < width <= 1, else std::invalid_argument.
  explicit BoundaryMap(double width);
  double to_box(double y) const;
  double from_box(double u) const;  // the preimage in [-1 - a, 1 + a]; u outside [-1, 1] is clamped
  // Coordinate by coordinate, any shape.
  Matrix to_box(const ConstMatrixRef& y) const;
  Vector from_box(const ConstVectorRef& u) const;
  // Half the length of the interval that maps onto the box once.
  double reach() const { return 1.0 + width_; }

 private:
  double width_;
};

}  // namespace odobench
