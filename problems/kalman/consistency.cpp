#include "problems/kalman/consistency.hpp"

#include <fmt/format.h>

#include <boost/math/distributions/chi_squared.hpp>
#include <stdexcept>

namespace odobench {

double chi_square_quantile(double probability, double dof) {
  if (!(dof > 0) || !(probability > 0) || !(probability < 1))
    throw std::invalid_argument(fmt::format(
        "chi-square quantile of probability {} with {} degrees of freedom: expected a probability "
        "between 0 and 1 and more than 0 degrees",
        probability, dof));
  return boost::math::quantile(boost::math::chi_squared(dof), probability);
}

ConsistencyBand consistency_band(double dof, double count, double probability) {
  const double tail = (1 - probability) / 2;
  return {chi_square_quantile(tail, dof * count) / count, chi_square_quantile(1 - tail, dof * count) / count};
}

}  // namespace odobench
