#include "reports/statistics/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <unordered_map>

#include "base/range.hpp"

namespace odobench {
namespace {

// Definition 7: position (N - 1) p between the order statistics.
double quantile(const std::vector<double>& sorted, double p) {
  const double position = static_cast<double>(sorted.size() - 1) * p;
  const auto below = static_cast<std::size_t>(position);
  if (below + 1 >= sorted.size()) return sorted.back();
  const double fraction = position - static_cast<double>(below);
  // Without the test, 0 * infinity or infinity - infinity would spoil the quantile.
  if (fraction == 0 || sorted[below] == sorted[below + 1]) return sorted[below];
  const double step = sorted[below + 1] - sorted[below];
  if (std::isinf(step)) return (1 - fraction) * sorted[below] + fraction * sorted[below + 1];
  return sorted[below] + fraction * step;
}

bool any_nan(const std::vector<double>& values) {
  return std::any_of(values.begin(), values.end(), [](double v) { return std::isnan(v); });
}

// Values near the largest double are added in units of the largest: a mean of finite numbers is finite.
double mean_of(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  double sum = 0, largest = 0;
  for (const double v : values) {
    sum += v;
    largest = std::max(largest, std::abs(v));
  }
  if (std::isfinite(sum) || !std::isfinite(largest)) return sum / n;
  sum = 0;
  for (const double v : values) sum += v / largest / n;
  return sum * largest;
}

double deviation_of(const std::vector<double>& values, double mean) {
  const auto degrees = static_cast<double>(values.size() - 1);
  double squares = 0, largest = 0;
  for (const double v : values) {
    squares += (v - mean) * (v - mean);
    largest = std::max(largest, std::abs(v - mean));
  }
  if (std::isfinite(squares) || !std::isfinite(largest)) return std::sqrt(squares / degrees);
  squares = 0;
  for (const double v : values) squares += std::pow((v - mean) / largest, 2) / degrees;
  return std::sqrt(squares) * largest;
}

}  // namespace

ErrorStatistics error_statistics_of(const std::vector<double>& repetitions) {
  if (repetitions.empty())
    throw std::invalid_argument("error statistics need at least one repetition, got 0");
  if (any_nan(repetitions)) return {kNotANumber, kNotANumber, kNotANumber};
  const double mean = mean_of(repetitions);
  return {*std::max_element(repetitions.begin(), repetitions.end()), mean,
          repetitions.size() < 2 ? kNotANumber : deviation_of(repetitions, mean)};
}

std::vector<TrajectoryErrors> error_statistics(const std::vector<RecordingError>& errors) {
  std::vector<std::string> names;
  std::unordered_map<std::string, std::size_t> places;
  std::vector<std::array<std::vector<double>, 3>> samples;
  for (const RecordingError& error : errors) {
    const auto [place, is_new] = places.emplace(error.trajectory, names.size());
    const std::size_t index = place->second;
    if (is_new) {
      names.push_back(error.trajectory);
      samples.emplace_back();
    }
    for (std::size_t v = 0; v < 3; ++v) samples[index][v].push_back(error.max_error[v]);
  }
  std::vector<TrajectoryErrors> result;
  for (std::size_t i = 0; i < names.size(); ++i) {
    result.push_back({names[i], {}});
    for (std::size_t v = 0; v < 3; ++v) result.back().variables[v] = error_statistics_of(samples[i][v]);
  }
  return result;
}

Totals error_totals(const std::vector<TrajectoryErrors>& errors) {
  Totals totals;
  for (const TrajectoryErrors& trajectory : errors)
    for (std::size_t v = 0; v < 3; ++v) totals.sums[v] += trajectory.variables[v].mean;
  totals.total = totals.sums[0] + totals.sums[1] + totals.sums[2];
  return totals;
}

Spread spread(std::vector<double> values) {
  if (values.empty()) throw std::invalid_argument("a spread needs at least one value, got 0");
  if (any_nan(values))
    return {values.size(), kNotANumber, kNotANumber, kNotANumber, kNotANumber, kNotANumber};
  std::sort(values.begin(), values.end());
  return {values.size(),         values.front(),         quantile(values, 0.25),
          quantile(values, 0.5), quantile(values, 0.75), values.back()};
}

}  // namespace odobench
