#include "reports/statistics/optimisers/friedman.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "base/range.hpp"
#include "reports/statistics/optimisers/quantiles.hpp"

namespace odobench {
namespace {

// Adds the ranks of a row to `sums`; returns sum of t^3 - t over its ties.
double add_row_ranks(const std::vector<double>& row, std::vector<double>& sums) {
  std::vector<double> values = row;
  for (double& value : values)
    if (std::isnan(value)) value = kInfinity;
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  double ties = 0;
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin + 1;
    while (end < order.size() && values[order[end]] == values[order[begin]]) ++end;
    for (std::size_t i = begin; i < end; ++i) sums[order[i]] += 0.5 * static_cast<double>(begin + 1 + end);
    const auto t = static_cast<double>(end - begin);
    ties += t * t * t - t;
    begin = end;
  }
  return ties;
}

double rank_error(std::size_t solvers, std::size_t problems) {
  const auto k = static_cast<double>(solvers);
  return std::sqrt(k * (k + 1) / (6 * static_cast<double>(problems)));
}

}  // namespace

FriedmanTest friedman_test(const std::vector<std::vector<double>>& scores) {
  if (scores.size() < 2 || scores.front().size() < 2)
    throw std::invalid_argument("a Friedman test needs two problems and two solvers at least");
  const std::size_t solvers = scores.front().size();
  std::vector<double> sums(solvers);
  double ties = 0;
  for (const std::vector<double>& row : scores) {
    if (row.size() != solvers)
      throw std::invalid_argument(
          fmt::format("a Friedman test: a row of {} scores, expected {}", row.size(), solvers));
    ties += add_row_ranks(row, sums);
  }
  const auto n = static_cast<double>(scores.size()), k = static_cast<double>(solvers);
  FriedmanTest test;
  test.problems = scores.size();
  double squares = 0;
  for (const double sum : sums) {
    test.mean_ranks.push_back(sum / n);
    squares += (sum - n * (k + 1) / 2) * (sum - n * (k + 1) / 2);
  }
  const double correction = 1 - ties / (n * (k * k * k - k));
  if (!(correction > 0)) return test;  // all scores equal in every row
  test.chi_squared = 12 * squares / (n * k * (k + 1)) / correction;
  test.p = chi_squared_tail(test.chi_squared, k - 1);
  const double rest = n * (k - 1) - test.chi_squared;
  test.f = rest > 1e-12 * n ? (n - 1) * test.chi_squared / rest : kInfinity;
  test.f_p = f_tail(test.f, k - 1, (k - 1) * (n - 1));
  return test;
}

double nemenyi_difference(std::size_t solvers, std::size_t problems, double alpha) {
  return range_quantile(alpha, static_cast<int>(solvers)) / std::numbers::sqrt2 *
         rank_error(solvers, problems);
}

double nemenyi_p(double difference, std::size_t solvers, std::size_t problems) {
  return range_tail(std::abs(difference) / rank_error(solvers, problems) * std::numbers::sqrt2,
                    static_cast<int>(solvers));
}

std::vector<RankBar> rank_bars(std::vector<double> mean_ranks, double difference) {
  std::sort(mean_ranks.begin(), mean_ranks.end());
  std::vector<RankBar> bars;
  for (std::size_t first = 0; first < mean_ranks.size(); ++first) {
    std::size_t last = first;
    while (last + 1 < mean_ranks.size() && mean_ranks[last + 1] - mean_ranks[first] <= difference) ++last;
    if (last > first && (bars.empty() || last > bars.back().last)) bars.push_back({first, last});
  }
  return bars;
}

}  // namespace odobench
