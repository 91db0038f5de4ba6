#include "reports/figures/decimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>
#include <stdexcept>

namespace odobench {
namespace {

// Slopes from the anchor that stay within the tolerance of every sample since.
struct Cone {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

// Keeps what the stretch between two kept samples needs.
void decimate_between(std::span<const double> abscissa, const std::vector<DecimatedChannel>& channels,
                      std::size_t first, std::size_t last, std::vector<std::size_t>& kept) {
  std::vector<Cone> cones(channels.size());
  std::size_t anchor = first;
  for (std::size_t k = first + 1; k <= last;) {
    const double step = abscissa[k] - abscissa[anchor];
    bool inside = true;
    for (std::size_t c = 0; c < channels.size() && inside; ++c) {
      const double slope = (channels[c].values[k] - channels[c].values[anchor]) / step;
      inside = cones[c].low <= slope && slope <= cones[c].high;  // false for what is not a number
    }
    if (!inside && k > anchor + 1) {  // the line to the sample before was the last that fits
      anchor = k - 1;
      kept.push_back(anchor);
      cones.assign(channels.size(), {});
      continue;
    }
    if (!inside) {  // a value here or at the anchor is not finite: both stay
      anchor = k++;
      if (anchor != last) kept.push_back(anchor);
      cones.assign(channels.size(), {});
      continue;
    }
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const double rise = channels[c].values[k] - channels[c].values[anchor];
      cones[c].low = std::max(cones[c].low, (rise - channels[c].tolerance) / step);
      cones[c].high = std::min(cones[c].high, (rise + channels[c].tolerance) / step);
    }
    ++k;
  }
}

}  // namespace

std::vector<std::size_t> decimate(std::span<const double> abscissa,
                                  const std::vector<DecimatedChannel>& channels) {
  const std::size_t n = abscissa.size();
  for (const DecimatedChannel& channel : channels)
    if (channel.values.size() != n)
      throw std::invalid_argument(
          fmt::format("decimate: a channel has {} values, the abscissa {}", channel.values.size(), n));
  if (n == 0) return {};
  std::set<std::size_t> kept{0, n - 1};
  for (const DecimatedChannel& channel : channels) {
    const auto [low, high] = std::minmax_element(channel.values.begin(), channel.values.end());
    kept.insert(static_cast<std::size_t>(low - channel.values.begin()));
    kept.insert(static_cast<std::size_t>(high - channel.values.begin()));
  }
  std::vector<std::size_t> all{0};
  for (auto left = kept.begin(), right = std::next(left); right != kept.end(); ++left, ++right) {
    decimate_between(abscissa, channels, *left, *right, all);
    all.push_back(*right);
  }
  return all;
}

std::vector<std::size_t> extremes(std::span<const double> values, std::size_t stretches) {
  if (stretches == 0) throw std::invalid_argument("extremes: expected at least one stretch");
  const std::size_t n = values.size();
  std::set<std::size_t> kept;
  if (n > 0) kept = {0, n - 1};
  for (std::size_t s = 0; s < stretches; ++s) {
    std::size_t low = n, high = n;
    for (std::size_t k = s * n / stretches; k < (s + 1) * n / stretches; ++k) {
      if (!std::isfinite(values[k])) continue;
      if (low == n || values[k] < values[low]) low = k;
      if (high == n || values[k] > values[high]) high = k;
    }
    if (low < n) kept.insert({low, high});
  }
  return {kept.begin(), kept.end()};
}

}  // namespace odobench
