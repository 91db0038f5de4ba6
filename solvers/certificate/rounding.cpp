#include "solvers/certificate/rounding.hpp"

#include <cmath>

namespace odobench {

double resolution_part_of_cost(const Box& box, const Vector& u, const Vector& length) {
  return 4.0 * length.cwiseProduct(box.resolution(u)).squaredNorm();
}

double rounding_part_of_cost(const Problem& problem, const Box& box, const Vector& u, const Vector& length,
                             double cost) {
  const double stated = problem.rounding_floor(box.to_parameters(u)) / cost;
  return std::max(resolution_part_of_cost(box, u, length), std::isfinite(stated) ? stated : 0.0);
}

}  // namespace odobench
