#include "solvers/box/boundary_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace odobench {

BoundaryMap::BoundaryMap(double width) : width_(width) {
  if (!(width > 0 && width <= 1))
    throw std::invalid_argument(fmt::format("boundary map: width {}; expected 0 < width <= 1", width));
}

double BoundaryMap::to_box(double y) const {
  const double r = reach();
  double t = y;
  if (std::abs(t) > r) {  // an odd triangle wave of period 4 r, like a sine
    t = std::fmod(t, 4.0 * r);
    if (t > 3.0 * r)
      t -= 4.0 * r;
    else if (t < -3.0 * r)
      t += 4.0 * r;
    else if (t > r)
      t = 2.0 * r - t;
    else if (t < -r)
      t = -2.0 * r - t;
  }
  const double size = std::abs(t);
  const double distance = r - size;
  const double u = size <= 1.0 - width_ ? size : 1.0 - distance * distance / (4.0 * width_);
  return std::copysign(std::min(u, 1.0), t);
}

double BoundaryMap::from_box(double u) const {
  const double size = std::min(std::abs(u), 1.0);
  const double y = size <= 1.0 - width_ ? size : reach() - 2.0 * std::sqrt(width_ * (1.0 - size));
  return std::copysign(y, u);
}

Matrix BoundaryMap::to_box(const ConstMatrixRef& y) const {
  return y.unaryExpr([this](double v) { return to_box(v); });
}

Vector BoundaryMap::from_box(const ConstVectorRef& u) const {
  return u.unaryExpr([this](double v) { return from_box(v); });
}

}  // namespace odobench
