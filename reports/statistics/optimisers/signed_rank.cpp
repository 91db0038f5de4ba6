#include "reports/statistics/optimisers/signed_rank.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <stdexcept>

#include "reports/statistics/optimisers/quantiles.hpp"

namespace odobench {
namespace {

struct SignedRanks {
  std::vector<std::int64_t> doubled;  // of |d|, midranks times two
  std::int64_t positive = 0;          // sum of those with d > 0
  double ties = 0;                    // sum of t^3 - t

  std::int64_t total() const { return std::accumulate(doubled.begin(), doubled.end(), std::int64_t{0}); }
};

SignedRanks signed_ranks(std::vector<double> d) {
  std::erase_if(d, [](double value) { return value == 0 || std::isnan(value); });
  std::sort(d.begin(), d.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  SignedRanks ranks;
  for (std::size_t begin = 0; begin < d.size();) {
    std::size_t end = begin + 1;
    while (end < d.size() && std::abs(d[end]) == std::abs(d[begin])) ++end;
    for (std::size_t i = begin; i < end; ++i) {
      ranks.doubled.push_back(static_cast<std::int64_t>(begin + 1 + end));
      if (d[i] > 0) ranks.positive += ranks.doubled.back();
    }
    const auto t = static_cast<double>(end - begin);
    ranks.ties += t * t * t - t;
    begin = end;
  }
  return ranks;
}

// ways[s]: choices of signs whose positive doubled ranks sum up to s.
std::vector<double> sign_sums(const std::vector<std::int64_t>& doubled) {
  const std::int64_t total = std::accumulate(doubled.begin(), doubled.end(), std::int64_t{0});
  std::vector<double> ways(static_cast<std::size_t>(total) + 1);
  ways[0] = 1;
  std::size_t reached = 0;
  for (const std::int64_t rank : doubled) {
    const auto r = static_cast<std::size_t>(rank);
    reached += r;
    for (std::size_t s = reached; s >= r; --s) ways[s] += ways[s - r];
  }
  return ways;
}

double exact_tail(const SignedRanks& ranks) {
  const std::int64_t total = ranks.total();
  const std::int64_t distance = std::abs(2 * ranks.positive - total);
  const std::vector<double> ways = sign_sums(ranks.doubled);
  double far = 0, all = 0;
  for (std::size_t s = 0; s < ways.size(); ++s) {
    all += ways[s];
    if (std::abs(2 * static_cast<std::int64_t>(s) - total) >= distance) far += ways[s];
  }
  return far / all;
}

double normal_tail(const SignedRanks& ranks) {
  const auto n = static_cast<double>(ranks.doubled.size());
  const double variance = n * (n + 1) * (2 * n + 1) / 24 - ranks.ties / 48;
  if (!(variance > 0)) return 1;
  const double distance = std::abs(0.5 * static_cast<double>(ranks.positive) - n * (n + 1) / 4) - 0.5;
  return distance <= 0 ? 1.0 : std::erfc(distance / std::sqrt(2 * variance));
}

SignedRankTest result_of(const SignedRanks& ranks, bool exact) {
  SignedRankTest test;
  test.pairs = ranks.doubled.size();
  test.positive = 0.5 * static_cast<double>(ranks.positive);
  test.exact = exact;
  if (test.pairs > 0) test.p = exact ? exact_tail(ranks) : normal_tail(ranks);
  return test;
}

// The largest c with P(W+ <= c - 1) <= alpha for n values without ties; 0: none.
std::size_t order_of_bound(std::size_t n, double alpha) {
  const auto count = static_cast<double>(n);
  if (n > kExactPairs) {
    const double sigma = std::sqrt(count * (count + 1) * (2 * count + 1) / 24);
    const double c = count * (count + 1) / 4 + normal_quantile(alpha) * sigma;
    return c < 1 ? 0 : static_cast<std::size_t>(c);
  }
  std::vector<std::int64_t> ranks(n);
  std::iota(ranks.begin(), ranks.end(), std::int64_t{1});
  const std::vector<double> ways = sign_sums(ranks);
  const double limit = alpha * std::ldexp(1.0, static_cast<int>(n));
  double below = 0;
  std::size_t c = 0;
  while (c < ways.size() && below + ways[c] <= limit) below += ways[c++];
  return c;
}

}  // namespace

SignedRankTest signed_rank_test(const std::vector<double>& differences) {
  const SignedRanks ranks = signed_ranks(differences);
  return result_of(ranks, ranks.doubled.size() <= kExactPairs);
}

SignedRankTest signed_rank_normal(const std::vector<double>& differences) {
  return result_of(signed_ranks(differences), false);
}

std::optional<PairedShift> paired_shift(const std::vector<double>& differences, double confidence) {
  if (differences.empty()) return std::nullopt;
  for (const double d : differences)
    if (!std::isfinite(d)) return std::nullopt;
  std::vector<double> means;
  means.reserve(differences.size() * (differences.size() + 1) / 2);
  for (std::size_t i = 0; i < differences.size(); ++i)
    for (std::size_t j = i; j < differences.size(); ++j)
      means.push_back(differences[i] / 2 + differences[j] / 2);
  std::sort(means.begin(), means.end());
  const std::size_t m = means.size();
  PairedShift shift;
  shift.estimate = m % 2 == 1 ? means[m / 2] : means[m / 2 - 1] / 2 + means[m / 2] / 2;
  const std::size_t c = order_of_bound(differences.size(), (1 - confidence) / 2);
  if (c > 0) {
    shift.lower = means[c - 1];
    shift.upper = means[m - c];
  }
  return shift;
}

ShareInterval wilson_interval(std::size_t successes, std::size_t trials, double confidence) {
  if (trials == 0 || successes > trials)
    throw std::invalid_argument(
        fmt::format("a share needs one trial at least, found {} of {}", successes, trials));
  const auto n = static_cast<double>(trials);
  const double p = static_cast<double>(successes) / n, z = normal_quantile((1 + confidence) / 2);
  const double middle = p + z * z / (2 * n), half = z * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n));
  const double scale = 1 + z * z / n;
  return {p, successes == 0 ? 0.0 : (middle - half) / scale,
          successes == trials ? 1.0 : (middle + half) / scale};
}

}  // namespace odobench
