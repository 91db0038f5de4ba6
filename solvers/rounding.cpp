#include "solvers/rounding.hpp"

#include <cmath>

namespace odobench {

double rounding_part_of_cost(const Problem& problem, const Box& box, const Vector& u, const Vector& length,
                             double cost) {
  const double stated = problem.rounding_floor(box.to_parameters(u)) / cost;
  const double moved = 4.0 * length.cwiseProduct(box.resolution(u)).squaredNorm();
  return std::max(moved, std::isfinite(stated) ? stated : 0.0);
}

}  // namespace odobench
