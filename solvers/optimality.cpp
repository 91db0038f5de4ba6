#include "solvers/optimality.hpp"

#include <cmath>
#include <limits>

#include "solvers/levenberg_marquardt.hpp"

namespace odobench {

double projected_cosine(const ConstVectorRef& u, const NormalEquations& e) {
  double largest = 0;
  for (Eigen::Index i = 0; i < u.size(); ++i) {
    const double scale = std::sqrt(e.jtj(i, i) * e.cost);
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

double predicted_gain(const Vector& u, const NormalEquations& e) {
  const Eigen::Index m = u.size();
  Matrix h = e.jtj;  // a trace of damping keeps it definite
  h.diagonal().array() += 1e-15 * std::max(h.diagonal().maxCoeff(), std::numeric_limits<double>::min());
  const Vector d = solve_box_quadratic(h, e.jtr, Vector::Constant(m, -1.0) - u, Vector::Constant(m, 1.0) - u);
  return -(2.0 * e.jtr.dot(d) + d.dot(e.jtj * d)) / e.cost;
}

}  // namespace odobench
