#include "reports/statistics/mann_whitney.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "base/range.hpp"

namespace odobench {
namespace {

// Both samples in one list; doubled midranks, which are integers even with ties.
struct Ranked {
  std::size_t before = 0, after = 0;
  std::vector<std::int64_t> doubled;  // of `before`, then of `after`
  double tie_term = 0;                // sum of t^3 - t

  std::int64_t after_sum() const {
    return std::accumulate(doubled.begin() + static_cast<std::ptrdiff_t>(before), doubled.end(),
                           std::int64_t{0});
  }
  // U = R - n2 (n2 + 1) / 2 with the rank sum R of `after`.
  double u(std::int64_t doubled_sum) const {
    const auto n = static_cast<double>(after);
    return 0.5 * static_cast<double>(doubled_sum) - 0.5 * n * (n + 1);
  }
  double mean() const { return 0.5 * static_cast<double>(before) * static_cast<double>(after); }
};

Ranked ranks_of(const std::vector<double>& before, const std::vector<double>& after) {
  if (before.empty() || after.empty())
    throw std::invalid_argument("a rank test needs at least one run on both sides");
  std::vector<double> values = before;
  values.insert(values.end(), after.begin(), after.end());
  for (double& value : values)
    if (std::isnan(value)) value = kInfinity;
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  Ranked ranked{before.size(), after.size(), std::vector<std::int64_t>(values.size()), 0};
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin + 1;
    while (end < order.size() && values[order[end]] == values[order[begin]]) ++end;
    // Ranks begin + 1 .. end have the mean (begin + 1 + end) / 2.
    for (std::size_t k = begin; k < end; ++k)
      ranked.doubled[order[k]] = static_cast<std::int64_t>(begin + 1 + end);
    const auto t = static_cast<double>(end - begin);
    ranked.tie_term += t * t * t - t;
    begin = end;
  }
  return ranked;
}

// ways[k][s]: subsets of k of the values whose doubled ranks sum up to s.
double exact_p(const Ranked& ranked) {
  const std::size_t take = std::min(ranked.before, ranked.after);  // the smaller side; the other has the rest
  const std::int64_t total = std::accumulate(ranked.doubled.begin(), ranked.doubled.end(), std::int64_t{0});
  const auto width = static_cast<std::size_t>(total) + 1;
  std::vector<std::vector<double>> ways(take + 1, std::vector<double>(width, 0.0));
  ways[0][0] = 1;
  std::size_t reached = 0;
  for (const std::int64_t rank : ranked.doubled) {
    const auto step = static_cast<std::size_t>(rank);
    reached += step;
    for (std::size_t k = take; k > 0; --k)
      for (std::size_t s = reached; s >= step; --s) ways[k][s] += ways[k - 1][s - step];
  }
  // In units of half a U, so that the comparison is one of integers: |2 R - n (N + 1)| for doubled sums.
  const auto n = static_cast<std::int64_t>(take);
  const auto mean = n * static_cast<std::int64_t>(ranked.doubled.size() + 1);
  const std::int64_t seen_sum =
      ranked.after <= ranked.before ? ranked.after_sum() : total - ranked.after_sum();
  const std::int64_t distance = std::abs(seen_sum - mean);
  double far = 0, all = 0;
  for (std::size_t s = 0; s < width; ++s) {
    all += ways[take][s];
    if (std::abs(static_cast<std::int64_t>(s) - mean) >= distance) far += ways[take][s];
  }
  return far / all;
}

double normal_p(const Ranked& ranked, double u) {
  const auto a = static_cast<double>(ranked.before), b = static_cast<double>(ranked.after);
  const double n = a + b;
  const double variance = a * b / 12 * ((n + 1) - ranked.tie_term / (n * (n - 1)));
  if (!(variance > 0)) return 1;  // all values equal
  const double z = (std::abs(u - ranked.mean()) - 0.5) / std::sqrt(variance);
  return z <= 0 ? 1.0 : std::erfc(z / std::sqrt(2.0));
}

// Order-preserving map between doubles and integers, to bisect over every double there is.
std::int64_t key_of(double value) {
  std::int64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits >= 0 ? bits : std::numeric_limits<std::int64_t>::min() - bits;
}
double value_of(std::int64_t key) {
  const std::int64_t bits = key >= 0 ? key : std::numeric_limits<std::int64_t>::min() - key;
  double value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

// Pairs with after - before <= limit; rounding keeps the order, so the count grows with the limit.
std::size_t pairs_up_to(const std::vector<double>& before, const std::vector<double>& after, double limit) {
  std::size_t count = 0, fitting = 0;
  for (const double a : before) {  // ascending: more of `after` fit with each
    while (fitting < after.size() && after[fitting] - a <= limit) ++fitting;
    count += fitting;
  }
  return count;
}

// The difference number `rank` (from 0) in ascending order.
double difference_at(const std::vector<double>& before, const std::vector<double>& after, std::size_t rank) {
  std::int64_t low = key_of(after.front() - before.back()), high = key_of(after.back() - before.front());
  while (low < high) {
    const std::int64_t middle = std::midpoint(low, high);
    if (pairs_up_to(before, after, value_of(middle)) > rank)
      high = middle;
    else
      low = middle + 1;
  }
  return value_of(low) + 0.0;
}

}  // namespace

RankTest rank_test(const std::vector<double>& before, const std::vector<double>& after) {
  const Ranked ranked = ranks_of(before, after);
  const double u = ranked.u(ranked.after_sum());
  if (before.size() + after.size() <= kExactRuns) return {u, exact_p(ranked), true};
  return {u, normal_p(ranked, u), false};
}

RankTest rank_test_normal(const std::vector<double>& before, const std::vector<double>& after) {
  const Ranked ranked = ranks_of(before, after);
  const double u = ranked.u(ranked.after_sum());
  return {u, normal_p(ranked, u), false};
}

double smallest_p(std::size_t before, std::size_t after) {
  const std::size_t take = std::min(before, after);
  if (take == 0) return 1;
  double deals = 1;
  for (std::size_t k = 1; k <= take; ++k)
    deals = deals * static_cast<double>(before + after - take + k) / static_cast<double>(k);
  return std::min(1.0, 2 / deals);
}

double probability_lower(const std::vector<double>& before, const std::vector<double>& after) {
  const Ranked ranked = ranks_of(before, after);
  return 1 - ranked.u(ranked.after_sum()) / (2 * ranked.mean());
}

std::string effect_size_name(double a12) {
  const double delta = std::abs(2 * a12 - 1);
  return delta < 0.147 ? "negligible" : delta < 0.33 ? "small" : delta < 0.474 ? "medium" : "large";
}

std::optional<double> median_shift(std::vector<double> before, std::vector<double> after) {
  if (before.empty() || after.empty()) return std::nullopt;
  for (const std::vector<double>* side : {&before, &after})
    for (const double value : *side)
      if (!std::isfinite(value)) return std::nullopt;
  std::sort(before.begin(), before.end());
  std::sort(after.begin(), after.end());
  const std::size_t pairs = before.size() * after.size();
  const double upper = difference_at(before, after, pairs / 2);
  return pairs % 2 == 1 ? upper : std::midpoint(difference_at(before, after, pairs / 2 - 1), upper);
}

std::vector<double> holm(const std::vector<double>& p_values) {
  std::vector<std::size_t> order(p_values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return p_values[a] < p_values[b]; });
  std::vector<double> adjusted(p_values.size());
  double largest = 0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    largest = std::max(largest, std::min(1.0, static_cast<double>(order.size() - k) * p_values[order[k]]));
    adjusted[order[k]] = largest;
  }
  return adjusted;
}

}  // namespace odobench
