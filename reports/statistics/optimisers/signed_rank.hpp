// Pairs of results: is one side lower, by how much, and how often is something solved.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace odobench {

// Wilcoxon's (1945) signed rank test of differences d = after - before. Zeros are left out (as Wilcoxon did),
// equal sizes get their mean rank:
//   W+ = sum of the ranks of |d| where d > 0
// p is two-sided: the probability that random signs give a W+ at least as far from its mean. Up to
// kExactPairs differences that are not zero it is exact, ties included: all 2^n sums of doubled mean ranks
// are counted by dynamic programming. Beyond that it is normal with the variance corrected for ties (t
// values per tie) and a continuity correction of 1/2:
//   z = (|W+ - n(n+1)/4| - 1/2) / s,   s^2 = n(n+1)(2n+1)/24 - sum (t^3 - t)/48
// Infinite differences (one side failed) have the largest ranks; not-a-number (both failed) counts as zero.
struct SignedRankTest {
  std::size_t pairs = 0;  // that are not zero
  double positive = 0;    // W+
  double p = 1;
  bool exact = true;
};
inline constexpr std::size_t kExactPairs = 50;  // 2^50 sums fit the integers of a double

SignedRankTest signed_rank_test(const std::vector<double>& differences);
// The approximation whatever the number of pairs, which tests compare with the exact one.
SignedRankTest signed_rank_normal(const std::vector<double>& differences);

// Hodges and Lehmann's (1963) estimate of the shift: the median of all means (d_i + d_j) / 2, i <= j, and the
// interval of those between which the true shift lies with at least the confidence asked for (the test turned
// round; exact for values without ties up to kExactPairs, else normal). No interval where so few pairs cannot
// give that confidence (below six for 95 %). None for no differences, or one that is not finite.
struct PairedShift {
  double estimate = 0;
  std::optional<double> lower, upper;
};
std::optional<PairedShift> paired_shift(const std::vector<double>& differences, double confidence = 0.95);

// Wilson's (1927) interval of a probability of which `successes` of `trials` are seen:
//   (p + z^2/2n +- z sqrt(p (1 - p)/n + z^2/4n^2)) / (1 + z^2/n),   p = successes / trials
// Throws std::invalid_argument for no trials, or more successes than trials.
struct ShareInterval {
  double share = 0, lower = 0, upper = 1;
};
ShareInterval wilson_interval(std::size_t successes, std::size_t trials, double confidence = 0.95);

}  // namespace odobench
