#include "bench/studies/importing/clock_offset.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "problems/robots/wheeled_robot.hpp"

namespace odobench {
namespace {

using log_import::Curve;
using log_import::LogCurves;
using log_import::LogMap;

constexpr double kGrid = 0.01, kSpan = 0.1, kLongestLag = 5, kLeastOverlap = 2;  // s
constexpr double kLeastRate = 0.1;                                               // rad/s
constexpr double kLongestLog = 5e4;  // s, a grid of whose stamps is made
constexpr int kSteps = 10;           // kSpan / kGrid

// Headings at begin + k * kGrid.
struct Heading {
  double begin = 0;
  std::vector<double> value;
};

Heading reference_heading(const Curve& curve) {
  Heading h{curve.time.front(), {}};
  std::size_t hint = 0;
  const auto count = static_cast<std::size_t>((curve.time.back() - h.begin) / kGrid) + 1;
  for (std::size_t k = 0; k < count; ++k)
    h.value.push_back(curve.at(h.begin + kGrid * static_cast<double>(k), hint));
  return h;
}

Heading wheel_heading(const LogMap& map, const LogCurves& curves) {
  double begin = -1e300, end = 1e300;
  for (const Curve& signal : curves.signals) {
    begin = std::max(begin, signal.time.front());
    end = std::min(end, signal.time.back());
  }
  Heading h{begin, {0}};
  if (!(begin + kSpan < end)) return h;
  const auto count = static_cast<Eigen::Index>((end - begin) / kGrid);
  const robots::WheeledRobot robot(map.robot.table);
  Matrix signals(static_cast<Eigen::Index>(robot.signals().size()), count);
  for (Eigen::Index row = 0; row < signals.rows(); ++row) {
    const auto found = std::find_if(curves.signals.begin(), curves.signals.end(), [&](const Curve& c) {
      return c.name == robot.signals()[static_cast<std::size_t>(row)];
    });
    std::size_t hint = 0;
    double before = found->at(begin, hint);
    for (Eigen::Index k = 0; k < count; ++k) {
      const double t = begin + kGrid * static_cast<double>(k + 1);
      const double now = found->at(row < robot.drive_count() ? t : t - kGrid / 2, hint);
      signals(row, k) = row < robot.drive_count() ? now - before : now;
      before = now;
    }
  }
  Matrix motions(3, count);
  robot.twists(signals, robot.nominal(), motions);
  for (Eigen::Index k = 0; k < count; ++k) h.value.push_back(h.value.back() + motions(2, k));
  return h;
}

std::vector<double> rates(const Heading& h) {
  std::vector<double> out;
  for (std::size_t k = kSteps; k < h.value.size(); ++k)
    out.push_back(std::abs(h.value[k] - h.value[k - kSteps]) / kSpan);
  return out;
}

// Normalised correlation of a[i + lag] with b[i] over what both have.
double correlation(const std::vector<double>& a, const std::vector<double>& b, long lag, long least) {
  const long from = std::max(0L, -lag);
  const long to = std::min(static_cast<long>(b.size()), static_cast<long>(a.size()) - lag);
  if (to - from < least) return -1;
  double sa = 0, sb = 0, aa = 0, bb = 0, ab = 0;
  for (long i = from; i < to; ++i) {
    const double p = a[static_cast<std::size_t>(i + lag)], q = b[static_cast<std::size_t>(i)];
    sa += p, sb += q, aa += p * p, bb += q * q, ab += p * q;
  }
  const double n = static_cast<double>(to - from);
  const double spread = (aa - sa * sa / n) * (bb - sb * sb / n);
  return spread > 0 ? (ab - sa * sb / n) / std::sqrt(spread) : -1;
}

// Every tenth of the rates.
std::vector<double> thinned(const std::vector<double>& rates) {
  std::vector<double> out;
  for (std::size_t k = 0; k < rates.size(); k += kSteps) out.push_back(rates[k]);
  return out;
}

// The lag in grid steps about which to search where the clocks share no time: the best of all, coarsely.
long lag_of_all(const std::vector<double>& a, const std::vector<double>& b, long least) {
  const std::vector<double> p = thinned(a), q = thinned(b);
  long best = 0;
  double highest = -2;
  for (long lag = -static_cast<long>(q.size()); lag < static_cast<long>(p.size()); ++lag)
    if (const double c = correlation(p, q, lag, least / kSteps); c > highest) highest = c, best = lag;
  return best * kSteps;
}

// Longest curve of the log [s].
double span(const LogCurves& curves) {
  double longest = curves.heading.time.back() - curves.heading.time.front();
  for (const Curve& signal : curves.signals)
    longest = std::max(longest, signal.time.back() - signal.time.front());
  return longest;
}

}  // namespace

std::optional<ClockOffset> clock_offset(const LogMap& map, const LogCurves& curves) {
  if (!(span(curves) < kLongestLog)) return std::nullopt;
  const Heading reference = reference_heading(curves.heading), wheels = wheel_heading(map, curves);
  const std::vector<double> a = rates(reference), b = rates(wheels);
  const auto turns = [](const std::vector<double>& r) {
    return std::any_of(r.begin(), r.end(), [](double rate) { return rate > kLeastRate; });
  };
  if (!turns(a) || !turns(b)) return std::nullopt;
  const long least =
      std::max<long>(std::lround(kLeastOverlap / kGrid), static_cast<long>(std::min(a.size(), b.size())) / 4);
  // Index i of b is at time wheels.begin + i kGrid; the same time has index i + shift of a.
  const double shift = (wheels.begin - reference.begin) / kGrid;
  const bool apart = shift > static_cast<double>(a.size()) || -shift > static_cast<double>(b.size());
  const long most = std::lround(kLongestLag / kGrid);
  const long about = apart ? lag_of_all(a, b, least) : std::lround(shift);
  std::vector<double> c;
  for (long lag = -most; lag <= most; ++lag) c.push_back(correlation(a, b, about + lag, least));
  const auto peak = std::max_element(c.begin(), c.end());
  if (!(*peak > 0) || peak == c.begin() || peak == c.end() - 1) return std::nullopt;
  const double left = peak[-1], right = peak[1], bend = left - 2 * *peak + right;
  const double part = bend < 0 ? (left - right) / (2 * bend) : 0;
  const double lag = static_cast<double>(peak - c.begin() - most) + part;
  ClockOffset found;
  found.seconds = kGrid * (lag + static_cast<double>(about) - shift);
  found.correlation = *peak;
  found.at_zero = apart ? 0 : c[static_cast<std::size_t>(most)];
  return found;
}

}  // namespace odobench
