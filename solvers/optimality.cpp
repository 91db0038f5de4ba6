#include "solvers/optimality.hpp"

#include <cmath>

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

}  // namespace odobench
