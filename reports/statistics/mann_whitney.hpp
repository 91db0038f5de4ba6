// Two samples of runs: is one lower than the other, by how much, and how sure is that.
//
// Smaller is better everywhere here; a caller that maximises negates. A run that failed has no value: it is
// given as not-a-number or +infinity, and both count as worse than every number and equal to each other.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace odobench {

// Mann-Whitney U of `after`: pairs (a, b) with a of `before`, b of `after` and b > a, ties counting one half:
//   U = #{b > a} + 1/2 #{b = a},   0 <= U <= n1 n2,   mean n1 n2 / 2 when the samples come from one
//   distribution
// (H. B. Mann, D. R. Whitney 1947). p is two-sided: the probability of a U at least as far from its mean when
// the n1 + n2 values that were seen are dealt out at random.
//
// Up to kExactRuns values in all, p is exact, ties included: the rank sums of all C(n1+n2, n1) deals are
// counted by dynamic programming on doubled midranks, in doubles that hold integers of this size exactly.
// Beyond that it is the normal approximation with the variance corrected for ties (t values per tie) and a
// continuity correction of 1/2:
//   z = (|U - n1 n2/2| - 1/2) / s,   s^2 = n1 n2 / 12 ((N + 1) - sum (t^3 - t) / (N (N - 1)))
struct RankTest {
  double u = 0;
  double p = 1;
  bool exact = true;
};
inline constexpr std::size_t kExactRuns = 56;  // C(56, 28) < 2^53 < C(57, 28)

// Throws std::invalid_argument when a sample is empty.
RankTest rank_test(const std::vector<double>& before, const std::vector<double>& after);
// The approximation whatever the number of values, which tests compare with the exact one.
RankTest rank_test_normal(const std::vector<double>& before, const std::vector<double>& after);

// The smallest two-sided p that so many runs without ties can give, 2 / C(n1+n2, n1): with 3 and 3 runs no
// difference, however large, gets below 0.1. 1 when a sample is empty.
double smallest_p(std::size_t before, std::size_t after);

// Vargha and Delaney's A12 (2000): the probability that a run of `after` is lower than one of `before`, ties
// counting one half,
//   A12 = 1 - U / (n1 n2);   0.5: no difference, 1: every run lower. Cliff's delta is 2 A12 - 1.
// Throws std::invalid_argument when a sample is empty.
double probability_lower(const std::vector<double>& before, const std::vector<double>& after);

// Of |2 A12 - 1|: "negligible" below 0.147, "small" below 0.33, "medium" below 0.474, else "large" (J. Romano
// and others 2006).
std::string effect_size_name(double a12);

// Hodges and Lehmann's (1963) estimate of the shift: the median of all n1 n2 differences after - before. None
// when a run failed or a sample is empty. Takes O((n1 + n2) log) time and no memory for the differences.
std::optional<double> median_shift(std::vector<double> before, std::vector<double> after);

// Holm's (1979) correction: p values adjusted so that the probability of a single false alarm among them all
// is at most the level they are compared with. In the order given; sorted ascending, p(k) becomes max over j
// <= k of min(1, (m - j + 1) p(j)).
std::vector<double> holm(const std::vector<double>& p_values);

}  // namespace odobench
