// Quantiles and tails of the distributions that the tests of this folder need.
#pragma once

namespace odobench {

// x with Phi(x) = p, 0 < p < 1.
double normal_quantile(double p);

// P(chi^2 with `degrees` > x), x >= 0.
double chi_squared_tail(double x, double degrees);

// P(F(numerator, denominator) > x), x >= 0; degrees > 0.
double f_tail(double x, double numerator, double denominator);

// P(range of k independent standard normal numbers > q), the studentised range for infinitely many degrees:
//   1 - k int phi(z) (Phi(z) - Phi(z - q))^(k-1) dz
// by the trapezoidal rule, which converges exponentially here: 1e-12 absolute. k >= 2.
double range_tail(double q, int k);
// q with range_tail(q, k) = alpha, 0 < alpha < 1.
double range_quantile(double alpha, int k);

}  // namespace odobench
