#include "problems/inspection/recording_checks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"

namespace odobench::inspection {
namespace {

constexpr double kOverflow = 50;    // times the 95th percentile: no wheel does that
constexpr double kFrozen = 0.4;     // s
constexpr double kRolled = 0.01;    // m
constexpr double kNormal = 1.4826;  // standard deviation by median absolute deviation

void mark(Drive& d, Index first, Index last) {
  for (Index k = std::max<Index>(0, first); k <= std::min(last, d.samples() - 1); ++k)
    d.bad[static_cast<std::size_t>(k)] = 1;
}

Finding in_recording(const Drive& d, std::string_view kind, const std::string& message,
                     std::map<std::string, double> figures) {
  Finding f = finding_of(kind, fmt::format("{}: {}", d.id(), message), std::move(figures));
  f.recording = d.id();
  return f;
}

// "3, 17, 40, ...".
std::string listed(const std::vector<Index>& samples) {
  const std::size_t shown = std::min<std::size_t>(samples.size(), 5);
  return fmt::format("{}{}",
                     fmt::join(samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(shown), ", "),
                     samples.size() > shown ? ", ..." : "");
}

// Whether the reference stood in the interval while held wheel speeds would have moved it.
bool only_clock_moved(const RobotView& robot, const Drive& d, Index k) {
  const double path = wheel_path(robot, d, k);
  if (!d.dense || d.increments || path < 0.05) return false;
  const double moved = std::hypot(d.x[k + 1] - d.x[k], d.y[k + 1] - d.y[k]) +
                       robot.distance * std::abs(wrapped_angle(d.theta[k + 1] - d.theta[k]));
  return moved < 0.2 * path;
}

void take_out_jump(Drive& d, Index k) {
  const double gap = d.seconds(k);
  d.motion.row(k) *= d.step / gap;
  d.t.tail(d.samples() - k - 1).array() -= gap - d.step;
  update_stamps(d);
}

void check_stamps(const RobotView& robot, Drive& d, std::vector<Finding>& found) {
  if (d.samples() < 2) return;
  Index k = 0;
  const double largest = (d.t.tail(d.samples() - 1) - d.t.head(d.samples() - 1)).maxCoeff(&k);
  if (!(largest > std::max(1.0, 20 * d.step))) return;
  const bool jump = only_clock_moved(robot, d, k);
  const std::string where = fmt::format("{:.4g} s between samples {} and {} (usual step {:.3g} ms)", largest,
                                        k, k + 1, 1000 * d.step);
  Finding f =
      jump ? in_recording(d, "clock_jump", where + ", in which the reference hardly moves: the clock jumped?",
                          {{"seconds", largest}, {"usual", d.step}})
           : in_recording(d, "gap", where, {{"seconds", largest}, {"usual", d.step}});
  f.sample = static_cast<std::size_t>(k);
  found.push_back(f);
  if (jump) {
    take_out_jump(d, k);
    return;
  }
  d.holes = true;
  mark(d, k - d.line.half(), k + 1 + d.line.half());
}

void check_turns(Drive& d, std::vector<Finding>& found) {
  const Index n = d.samples();
  const Vector steps = (d.theta.tail(n - 1) - d.theta.head(n - 1)).cwiseAbs();
  if (!(steps.maxCoeff() > 5.5)) return;
  std::vector<double> sorted(steps.data(), steps.data() + steps.size());
  if (!(median(sorted) < 0.2)) return;
  std::vector<Index> jumps;
  for (Index k = 0; k + 1 < n; ++k)
    if (steps[k] > 5.5 && steps[k] < 7) jumps.push_back(k + 1);
  if (jumps.empty()) return;
  Finding f = in_recording(d, "heading_wrapped",
                           fmt::format("theta jumps by 2 pi at sample {}{}", jumps.front(),
                                       jumps.size() > 1 ? fmt::format(" and {} more", jumps.size() - 1) : ""),
                           {{"jumps", static_cast<double>(jumps.size())}});
  f.sample = static_cast<std::size_t>(jumps.front());
  found.push_back(f);
  for (const Index k : jumps) {
    const double turn = std::round((d.theta[k] - d.theta[k - 1]) / (2 * kPi)) * 2 * kPi;
    d.theta.tail(n - k).array() -= turn;
  }
}

void check_pose(Drive& d, const char* name, const char* unit, double floor, Vector& v,
                std::vector<Finding>& found) {
  const std::vector<Index> samples = pose_outliers(v, floor);
  if (samples.empty()) return;
  double largest = 0;
  Index at = samples.front();
  std::vector<double> medians;
  for (const Index k : samples) {
    medians.push_back(median_of_seven(v, k));
    const double off = std::abs(v[k] - medians.back());
    if (off > largest) {
      largest = off;
      at = k;
    }
  }
  Finding f = in_recording(d, "pose_outlier",
                           fmt::format("{} of {} sample{} {} off {} neighbours by up to {:.3g} {}", name,
                                       samples.size(), samples.size() == 1 ? "" : "s", listed(samples),
                                       samples.size() == 1 ? "its" : "their", largest, unit),
                           {{"samples", static_cast<double>(samples.size())}, {"largest", largest}});
  f.sample = static_cast<std::size_t>(at);
  found.push_back(f);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    v[samples[i]] = medians[i];
    mark(d, samples[i], samples[i]);
  }
}

std::size_t wheel_of(const RobotView& robot, Index column) {
  for (std::size_t i = 0; i < robot.wheels.size(); ++i)
    for (const auto& [own, weight] : robot.wheels[i].drives)
      if (own == column) return i;
  return 0;
}

void check_spikes(const RobotView& robot, Drive& d, Index column, std::vector<Finding>& found) {
  const Index n = d.samples();
  const Vector seconds = d.t.tail(n - 1) - d.t.head(n - 1);
  Vector speeds = d.motion.col(column).cwiseQuotient(seconds);
  double usual = 0;
  const std::vector<Index> at = spikes(speeds.cwiseAbs(), usual);
  if (at.empty()) return;
  Index worst = at.front();
  for (const Index k : at)
    if (std::abs(speeds[k]) > std::abs(speeds[worst])) worst = k;
  const std::size_t wheel = wheel_of(robot, column);
  const std::string& signal = robot.twist.signals()[static_cast<std::size_t>(column)];
  const Index shift = d.increments ? 1 : 0;
  const bool overflow = std::abs(speeds[worst]) > kOverflow * usual;
  Finding f = in_recording(
      d, overflow ? "encoder_overflow" : "wheel_spike",
      fmt::format("{} speed {:.4g} rad/s at sample {}{} (95 % are below {:.3g} rad/s){}",
                  robot.wheels[wheel].drives.size() > 1 ? signal : robot.wheels[wheel].label, speeds[worst],
                  worst + shift, at.size() > 1 ? fmt::format(" and {} more", at.size() - 1) : "", usual,
                  overflow ? ": a counter overflowed?" : ""),
      {{"speed", speeds[worst]}, {"usual", usual}, {"samples", static_cast<double>(at.size())}});
  f.wheel = wheel + 1;
  f.sample = static_cast<std::size_t>(worst + shift);
  f.signal = signal;
  found.push_back(f);
  std::vector<double> medians;
  for (const Index k : at) medians.push_back(median_of_seven(speeds, k));
  for (std::size_t i = 0; i < at.size(); ++i) {
    d.motion(at[i], column) = medians[i] * seconds[at[i]];
    mark(d, at[i], at[i] + 1);
  }
}

void check_frozen(const RobotView& robot, Drive& d, std::vector<Finding>& found) {
  const Index n = d.samples();
  std::vector<char> same(static_cast<std::size_t>(n - 1));
  for (Index k = 0; k + 1 < n; ++k)
    same[static_cast<std::size_t>(k)] =
        d.x[k + 1] == d.x[k] && d.y[k + 1] == d.y[k] && d.theta[k + 1] == d.theta[k] ? 1 : 0;
  for (const Stretch& run : stretches(same, 2)) {
    const double seconds = d.t[run.last + 1] - d.t[run.first];
    double path = 0;
    for (Index k = run.first; k <= run.last; ++k) path += wheel_path(robot, d, k);
    if (seconds < kFrozen || path <= kRolled) continue;
    Finding f =
        in_recording(d, "capture_frozen",
                     fmt::format("the pose stands still from sample {} to {} ({:.3g} s) while the wheels "
                                 "roll {:.3g} m",
                                 run.first, run.last + 1, seconds, path),
                     {{"seconds", seconds}, {"rolled", path}});
    f.first = static_cast<std::size_t>(run.first);
    f.last = static_cast<std::size_t>(run.last + 1);
    found.push_back(f);
    mark(d, run.first - d.line.half(), run.last + 1 + d.line.half());
  }
}

}  // namespace

std::vector<Index> pose_outliers(const Vector& v, double floor) {
  const Index n = v.size();
  const Vector steps = (v.tail(n - 1) - v.head(n - 1)).cwiseAbs();
  if (3 * steps.maxCoeff() <= floor) return {};  // no sample can be further from its median
  const Vector e = off_median(v);
  std::vector<double> moved(steps.data(), steps.data() + steps.size()), off;
  for (Index k = 3; k + 3 < n; ++k)  // windows that are whole
    if (e[k] > 0) off.push_back(e[k]);
  const double limit = std::max({floor, 10 * kNormal * median(off), 6 * percentile(moved, 0.9)});
  std::vector<Index> found;
  for (Index k = 0; k < n; ++k)
    if (e[k] > limit) found.push_back(k);
  if (static_cast<double>(found.size()) > std::max(3.0, 0.01 * static_cast<double>(n))) found.clear();
  return found;
}

std::vector<Index> spikes(const Vector& magnitude, double& usual) {
  const double largest = magnitude.size() > 0 ? magnitude.maxCoeff() : 0;
  const auto high = (magnitude.array() * 8 >= largest).count();
  if (static_cast<double>(high) > 0.06 * static_cast<double>(magnitude.size()) + 1) return {};
  std::vector<double> sorted(magnitude.data(), magnitude.data() + magnitude.size());
  usual = percentile(sorted, 0.95);
  std::vector<Index> found;
  if (!(usual > 0)) return found;
  for (Index k = 0; k < magnitude.size(); ++k)
    if (magnitude[k] > 8 * usual) found.push_back(k);
  if (static_cast<double>(found.size()) > std::max(3.0, 0.005 * static_cast<double>(magnitude.size())))
    found.clear();
  return found;
}

std::vector<Finding> check_recording(const RobotView& robot, Drive& d) {
  std::vector<Finding> found;
  check_stamps(robot, d, found);
  if (d.dense) {
    check_turns(d, found);
    check_pose(d, "x", "m", 0.02, d.x, found);
    check_pose(d, "y", "m", 0.02, d.y, found);
    check_pose(d, "theta", "rad", 0.1, d.theta, found);
  }
  for (Index column = 0; column < d.motion.cols() && d.samples() >= 5; ++column)
    check_spikes(robot, d, column, found);
  if (d.dense) check_frozen(robot, d, found);
  return found;
}

}  // namespace odobench::inspection
