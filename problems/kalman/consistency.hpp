// Is a filter as good as it says? NEES = e' P^-1 e over the errors e of the state, NIS over the innovations;
// both are chi-square distributed when the model is right (Y. Bar-Shalom, X. R. Li, T. Kirubarajan,
// Estimation with Applications to Tracking and Navigation, 2001, 5.4).
#pragma once

namespace odobench {

// x with P(chi-square of `dof` <= x) = probability. Throws std::invalid_argument unless dof > 0 and
// 0 < probability < 1.
double chi_square_quantile(double probability, double dof);

// The two-sided band that holds the mean of `count` independent chi-square values of `dof` with
// `probability`.
struct ConsistencyBand {
  double lower = 0;
  double upper = 0;
  bool holds(double mean) const { return mean >= lower && mean <= upper; }
};
ConsistencyBand consistency_band(double dof, double count, double probability = 0.95);

}  // namespace odobench
