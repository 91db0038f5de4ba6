#include "reports/statistics/optimisers/quantiles.hpp"

#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/erf.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <numbers>

namespace odobench {
namespace {

double normal_density(double z) {
  return std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi);
}

double normal_below(double z) {
  return std::erfc(-z / std::numbers::sqrt2) / 2;
}

}  // namespace

double normal_quantile(double p) {
  return -std::numbers::sqrt2 * boost::math::erfc_inv(2 * p);
}

double chi_squared_tail(double x, double degrees) {
  return boost::math::gamma_q(degrees / 2, x / 2);
}

double f_tail(double x, double numerator, double denominator) {
  if (std::isinf(x)) return 0;
  return boost::math::ibeta(denominator / 2, numerator / 2, denominator / (denominator + numerator * x));
}

double range_tail(double q, int k) {
  if (q <= 0) return 1;
  constexpr double kEnd = 9, kStep = 1.0 / 16;  // phi(9) = 1e-18
  double sum = 0;
  for (double z = -kEnd; z <= kEnd + q; z += kStep)
    sum += normal_density(z) * std::pow(normal_below(z) - normal_below(z - q), k - 1);
  return std::fmax(0.0, 1 - k * kStep * sum);
}

double range_quantile(double alpha, int k) {
  double low = 0, high = 20;
  for (int step = 0; step < 100; ++step) {
    const double middle = (low + high) / 2;
    (range_tail(middle, k) > alpha ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace odobench
