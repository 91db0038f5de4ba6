// Several solvers on several problems: do their ranks differ, and which of them.
//
// Smaller scores are better; +infinity (and not-a-number) is a failure, worse than every number and equal to
// other failures.
#pragma once

#include <cstddef>
#include <vector>

namespace odobench {

// Friedman's (1937) test on N rows (problems) of k scores (solvers): ranks 1 (best) .. k within each row,
// equal scores share their mean, R_j the sum of column j:
//   chi2 = (12 / (N k (k+1)) sum R_j^2 - 3 N (k+1)) / (1 - sum (t^3 - t) / (N (k^3 - k))),   k - 1 degrees
// with t values per tie, and what Iman and Davenport (1980) make of it, which is less conservative:
//   F = (N - 1) chi2 / (N (k - 1) - chi2),   k - 1 and (k - 1)(N - 1) degrees
struct FriedmanTest {
  std::vector<double> mean_ranks;  // per solver
  std::size_t problems = 0;
  double chi_squared = 0, p = 1;
  double f = 0, f_p = 1;
};
// Throws std::invalid_argument for fewer than two rows or columns, or rows of different lengths.
FriedmanTest friedman_test(const std::vector<std::vector<double>>& scores);

// Nemenyi's (1963) critical difference of mean ranks: q_alpha sqrt(k (k+1) / (6 N)), q_alpha the quantile
// of the studentised range for k groups and infinitely many degrees, over sqrt(2) (J. Demsar, Statistical
// comparisons of classifiers over multiple data sets, JMLR 7, 2006, table 5).
double nemenyi_difference(std::size_t solvers, std::size_t problems, double alpha = 0.05);
// The p value of two solvers whose mean ranks differ by `difference`, adjusted for all pairs.
double nemenyi_p(double difference, std::size_t solvers, std::size_t problems);

// The bars of a critical-difference diagram: sets of solvers, as positions in ascending order of mean
// rank, no two of which differ by more than `difference`; each as first and last position, none inside
// another, none of a single solver.
struct RankBar {
  std::size_t first = 0, last = 0;
  bool operator==(const RankBar&) const = default;
};
std::vector<RankBar> rank_bars(std::vector<double> mean_ranks, double difference);

}  // namespace odobench
