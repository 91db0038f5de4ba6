#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "problems/inspection/hypotheses.hpp"
#include "problems/inspection/set_checks.hpp"

namespace odobench::inspection {
namespace {

constexpr double kUnrelated = 0.3;
constexpr double kUnlike = 0.02, kTimesOthers = 8;
constexpr double kStretch = 0.3;  // s
constexpr double kOfLevel = 0.3, kOfScatter = 8 * 1.4826, kOfOthers = 2.5;
constexpr double kMostSlipping = 0.2;  // of the samples: beyond it is no slip

double median_of(std::vector<double> values) {
  return median(values);
}

// res_i = u_i.(a / |a|) - k_i m_i of every driven wheel, the others stay 0.
Matrix residuals_of(const RobotView& robot, const Drive& d, const Vector& slope) {
  Matrix out = Matrix::Zero(d.samples(), static_cast<Index>(robot.wheels.size()));
  for (std::size_t i = 0; i < robot.wheels.size(); ++i) {
    const auto column = static_cast<Index>(i);
    if (!std::isfinite(slope[column])) continue;
    out.col(column) = velocity_of(robot, d, i).along - slope[column] * rolling_of(robot, d, i);
  }
  return out;
}

// Whether the wheel's signal says one value in half of the stretch at least (the filter makes stretches
// longer), while the velocity by the reference changes by more than what makes a stretch.
bool repeats(const RobotView& robot, const Drive& d, std::size_t wheel, const Stretch& run) {
  const Index column = robot.wheels[wheel].drives.front().first,
              last = std::min(run.last, d.motion.rows() - 1);
  const auto equal = [&](Index k) {
    const double a = d.motion(k - 1, column) / d.seconds(k - 1), b = d.motion(k, column) / d.seconds(k);
    return std::abs(a - b) <= 1e-9 * std::abs(b);
  };
  Stretch longest{run.first, run.first};
  for (Index k = run.first; k <= last;) {
    Stretch one{k, k};
    while (one.last < last && equal(one.last + 1)) ++one.last;
    if (one.size() > longest.size()) longest = one;
    k = one.last + 1;
  }
  if (2 * longest.size() < run.size()) return false;
  while (longest.first > 0 && equal(longest.first)) --longest.first;
  const Vector along = velocity_of(robot, d, wheel).along.segment(longest.first, longest.size());
  return along.maxCoeff() - along.minCoeff() > kOfLevel * d.level;
}

// Stretches where the wheel is off by more than its own scatter and than the others.
std::vector<Stretch> slipping(const RobotView& robot, const Drive& d, const Matrix& residuals,
                              std::size_t wheel) {
  const auto column = static_cast<Index>(wheel);
  const double least = kOfLevel * d.level;
  if (!(residuals.col(column).cwiseAbs().maxCoeff() > least)) return {};
  std::vector<double> off(residuals.col(column).data(), residuals.col(column).data() + d.samples());
  const double middle = median_of(off);
  for (double& v : off) v = std::abs(v - middle);
  const double limit = std::max(least, kOfScatter * median_of(off));
  std::vector<char> holds(static_cast<std::size_t>(d.samples()), 0);
  for (Index k = 0; k < d.samples(); ++k) {
    const double own = std::abs(residuals(k, column));
    if (own <= limit || d.bad[static_cast<std::size_t>(k)] != 0) continue;
    std::vector<double> others;
    for (std::size_t i = 0; i < robot.wheels.size(); ++i)
      if (i != wheel && robot.wheels[i].driven())
        others.push_back(std::abs(residuals(k, static_cast<Index>(i))));
    if (others.empty() || own > kOfOthers * median(others)) holds[static_cast<std::size_t>(k)] = 1;
  }
  std::vector<Stretch> found;
  for (const Stretch& run : stretches(holds, 2))
    if (d.t[run.last] - d.t[run.first] >= kStretch) found.push_back(run);
  return found;
}

void check_slip(const RobotView& robot, const Drive& d, const Vector& slope, std::vector<Finding>& found) {
  const Matrix residuals = residuals_of(robot, d, slope);
  std::vector<Finding> slips;
  Index samples = 0;
  for (std::size_t i = 0; i < robot.wheels.size(); ++i) {
    if (!robot.wheels[i].driven()) continue;
    for (const Stretch& run : slipping(robot, d, residuals, i)) {
      const Vector one = residuals.col(static_cast<Index>(i)).segment(run.first, run.size());
      const double off = -one.mean();
      const std::string when = fmt::format("from {:.4g} to {:.4g} s", d.t[run.first], d.t[run.last]);
      const bool same = repeats(robot, d, i, run);
      const double said = d.motion(run.first, robot.wheels[i].drives.front().first) / d.seconds(run.first);
      Finding f =
          same ? finding_of("speeds_repeat",
                            fmt::format("{}: {} says {:.4g} rad/s again and again {} while the reference "
                                        "changes by up to {:.2g} m/s",
                                        d.id(), robot.wheels[i].label, said, when, one.cwiseAbs().maxCoeff()),
                            {{"speed", said}, {"largest", one.cwiseAbs().maxCoeff()}})
               : finding_of("wheel_slip",
                            fmt::format("{}: {} rolls {:+.2g} m/s off the reference {}", d.id(),
                                        robot.wheels[i].label, off, when),
                            {{"off", off}, {"from", d.t[run.first]}, {"to", d.t[run.last]}});
      f.recording = d.id();
      f.wheel = i + 1;
      f.first = static_cast<std::size_t>(run.first);
      f.last = static_cast<std::size_t>(run.last);
      if (same) {
        found.push_back(f);
      } else {
        slips.push_back(f);
        samples += run.size();
      }
    }
  }
  if (static_cast<double>(samples) <= kMostSlipping * static_cast<double>(d.samples()))
    found.insert(found.end(), slips.begin(), slips.end());
}

// A wheel that never says anything.
void check_silent(const RobotView& robot, const Sums& sums, std::vector<Finding>& found) {
  for (std::size_t i = 0; i < robot.wheels.size(); ++i) {
    const auto at = static_cast<Index>(i);
    if (!robot.wheels[i].driven() || sums.own[at] > 0 || !(sums.all[at] > 0)) continue;
    found.push_back(finding_of("speeds_repeat",
                               robot.wheels[i].label + " says 0 all the time while the robot moves",
                               {{"speed", 0.0}}));
    found.back().wheel = i + 1;
  }
}

}  // namespace

std::vector<Finding> check_recordings_alike(const RobotView& robot, DriveSet& drives, bool rotation_is_off) {
  std::vector<Finding> found;
  std::vector<Sums> each(drives.size());
  Sums all(robot.wheels.size());
  drives.correct([&robot](Drive& d) { update_sums(robot, d); });
  drives.visit_parallel([&](std::size_t i, const Drive& d) { each[i] = d.sums; });
  for (const Sums& one : each) all += one;
  check_silent(robot, all, found);
  const SlopeFit fit = slope_fit(robot, all);
  std::vector<double> misfits;
  std::size_t unrelated = 0;
  for (const Sums& sums : each) {
    misfits.push_back(misfit_with(sums, fit.slope));
    if (misfits.back() > kUnrelated) ++unrelated;
  }
  if (fit.misfit > kUnrelated && 2 * unrelated > drives.size()) {
    found.push_back(
        finding_of("not_together",
                   fmt::format("wheels and reference do not belong together (misfit {:.2g} of the "
                               "squares of the velocities)",
                               fit.misfit),
                   {{"misfit", fit.misfit}}));
    return found;
  }
  if (rotation_is_off) return found;
  const double usual = median_of(misfits);
  for (std::size_t i = 0; i < drives.size() && drives.size() > 1; ++i) {
    if (!(misfits[i] > kUnlike) || !(misfits[i] > kTimesOthers * usual)) continue;
    found.push_back(finding_of(
        "recording_unlike",
        fmt::format("{}: wheels and reference disagree by {:.2g} % (median of the others {:.2g} %)",
                    drives.recording(i).id, 100 * std::sqrt(misfits[i]),
                    100 * std::sqrt(std::max(0.0, usual))),
        {{"disagreement", std::sqrt(misfits[i])}, {"others", std::sqrt(std::max(0.0, usual))}}));
    found.back().recording = drives.recording(i).id;
  }
  std::vector<std::vector<Finding>> slips(drives.size());
  drives.visit_parallel([&](std::size_t i, const Drive& d) { check_slip(robot, d, fit.slope, slips[i]); });
  for (const std::vector<Finding>& one : slips) found.insert(found.end(), one.begin(), one.end());
  return found;
}

}  // namespace odobench::inspection
