#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "problems/inspection/set_checks.hpp"

namespace odobench::inspection {
namespace {

constexpr double kReported = 0.02;  // s
constexpr double kSure = 4;         // standard deviations
constexpr double kSearched = 0.5;   // s
constexpr Index kFewest = 40;       // samples of a recording
constexpr double kFloor = 0.003;    // s, what recordings differ by anyway

// Three columns of samples at stamps t -> rows on a grid of step T.
Matrix on_grid(const Vector& t, const Matrix& columns, double step, Index points) {
  Matrix grid(3, points);
  Index at = 0;
  for (Index k = 0; k < points; ++k) {
    const double time = t[0] + static_cast<double>(k) * step;
    while (at + 2 < t.size() && t[at + 1] <= time) ++at;
    const double part = (time - t[at]) / (t[at + 1] - t[at]);
    grid.col(k) = ((1 - part) * columns.row(at) + part * columns.row(at + 1)).transpose();
  }
  return grid;
}

Lag drive_lag(const RobotView& robot, const Drive& d) {
  const Index n = d.samples();
  if (n < kFewest || d.holes || !(d.step > 0)) return {};
  const auto points = static_cast<Index>((d.t[n - 1] - d.t[0]) / d.step) + 1;
  if (points > 4 * n) return {};
  Matrix wheels = d.twist, reference(n, 3);
  wheels.col(2) *= robot.distance;
  reference << d.fx, d.fy, robot.distance * d.w;
  const Index most = std::min(static_cast<Index>(kSearched / d.step), points / 4);
  return lag_of(on_grid(d.t, wheels, d.step, points), on_grid(d.t, reference, d.step, points), d.step, most,
                static_cast<double>(2 * d.line.half() + 1));
}

struct SetLag {
  double mean = 0, deviation = 0;
  std::size_t late = 0;                 // recordings beyond the limit
  double low = 0, high = 0, usual = 0;  // of those with a deviation below 10 ms
  std::string lowest, highest;
};

SetLag set_lag(const std::vector<Lag>& lags, const std::vector<std::string>& of) {
  SetLag set;
  double weights = 0;
  std::vector<double> values, sure;
  set.low = 1e9;
  set.high = -1e9;
  for (std::size_t i = 0; i < lags.size(); ++i) {
    const Lag& lag = lags[i];
    const double weight = 1 / (lag.deviation * lag.deviation + kFloor * kFloor);
    weights += weight;
    set.mean += weight * lag.seconds;
    values.push_back(lag.seconds);
    if (std::abs(lag.seconds) > kReported && std::abs(lag.seconds) > kSure * lag.deviation) ++set.late;
    if (!(lag.deviation < 0.01)) continue;
    sure.push_back(lag.deviation);
    if (lag.seconds < set.low) set.lowest = of[i];
    if (lag.seconds > set.high) set.highest = of[i];
    set.low = std::min(set.low, lag.seconds);
    set.high = std::max(set.high, lag.seconds);
  }
  set.mean /= weights;
  const double middle = median(values);
  for (double& v : values) v = std::abs(v - middle);
  set.deviation = std::max(1 / std::sqrt(weights),
                           1.2533 * 1.4826 * median(values) / std::sqrt(static_cast<double>(values.size())));
  set.usual = median(sure);
  return set;
}

}  // namespace

Vector shifted(const Vector& t, const Vector& v, double lag) {
  Vector out(v.size());
  Index at = 0;
  const Index n = t.size();
  for (Index k = 0; k < n; ++k) {
    const double time = std::clamp(t[k] + lag, t[0], t[n - 1]);
    while (at + 2 < n && t[at + 1] <= time) ++at;
    const double part = (time - t[at]) / (t[at + 1] - t[at]);
    out[k] = (1 - part) * v[at] + part * v[at + 1];
  }
  return out;
}

std::vector<Finding> check_lag(const RobotView& robot, DriveSet& drives) {
  std::vector<Lag> each(drives.size());
  drives.visit_parallel([&](std::size_t i, const Drive& d) { each[i] = drive_lag(robot, d); });
  std::vector<Lag> lags;
  std::vector<std::string> of;
  for (std::size_t i = 0; i < drives.size(); ++i) {
    if (!each[i].usable) continue;
    lags.push_back(each[i]);
    of.push_back(drives.recording(i).id);
  }
  if (lags.empty()) return {};
  const SetLag set = set_lag(lags, of);
  const bool all = std::abs(set.mean) > kReported && std::abs(set.mean) > kSure * set.deviation;
  const double enough = std::max(2.0, 0.3 * static_cast<double>(lags.size()));
  if (!all && static_cast<double>(set.late) < enough) return {};
  Finding f = finding_of("reference_lag",
                         fmt::format("the reference {} the wheels by {:.0f} ms (sd {:.1f} ms)",
                                     set.mean > 0 ? "lags behind" : "runs ahead of",
                                     1000 * std::abs(set.mean), 1000 * set.deviation),
                         {{"lag", set.mean}, {"deviation", set.deviation}});
  if (set.high - set.low > std::max(0.02, 8 * set.usual)) {
    f.message += fmt::format("; it differs between drives: {:.0f} ms in {} to {:.0f} ms in {}",
                             1000 * set.low, set.lowest, 1000 * set.high, set.highest);
    f.figures["lowest"] = set.low;
    f.figures["highest"] = set.high;
    f.mendable = false;
  }
  drives.correct([lag = set.mean](Drive& d) {
    for (Vector* v : {&d.x, &d.y, &d.theta}) *v = shifted(d.t, *v, lag);
    update_reference(d);
  });
  return {f};
}

}  // namespace odobench::inspection
