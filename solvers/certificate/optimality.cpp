#include "solvers/certificate/optimality.hpp"

#include <cmath>

namespace odobench {

double projected_cosine(const ConstVectorRef& u, const NormalEquations& e) {
  double largest = 0;
  for (Eigen::Index i = 0; i < u.size(); ++i) {
    const double scale = std::sqrt(e.jtj(i, i)) * std::sqrt(e.cost);  // their product may overflow
    if (!held_by_bound(u[i], e.jtr[i]) && scale > 0) largest = std::max(largest, std::abs(e.jtr[i]) / scale);
  }
  return largest;
}

double projected_gradient(const ConstVectorRef& u, const ConstVectorRef& g) {
  double largest = 0;
  for (Eigen::Index i = 0; i < u.size(); ++i)
    if (!held_by_bound(u[i], g[i])) largest = std::max(largest, std::abs(g[i]));
  return largest;
}

Vector put_on_bounds(const Vector& u, const ConstVectorRef& gradient, double distance) {
  Vector snapped = u;
  for (Eigen::Index i = 0; i < u.size(); ++i) {
    const double bound = u[i] < 0 ? -1.0 : 1.0;
    if (std::abs(u[i] - bound) < distance && held_by_bound(bound, gradient[i])) snapped[i] = bound;
  }
  return snapped;
}

}  // namespace odobench
