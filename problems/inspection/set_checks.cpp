#include "problems/inspection/set_checks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "base/angle.hpp"

namespace odobench::inspection {
namespace {

using Complex = std::complex<double>;

constexpr double kStart = 0.05;   // m
constexpr double kFactor = 1.12;  // what nominal values are not off by
constexpr double kNamed = 0.15;   // of a logarithm
constexpr double kAngle = 1 * kDegree;
constexpr double kSpread = 0.6 * kDegree;
constexpr double kLever = 0.01;       // m
constexpr Index kFewestSamples = 10;  // that say something

enum class Motion { Straight, Turning, Other };

Motion motion_of(const RobotView& robot, const Drive& d, Index k) {
  const double vx = d.twist(k, 0), vy = d.twist(k, 1), turn = robot.distance * d.twist(k, 2);
  const double along = vx * vx + vy * vy, turning = turn * turn;
  if (d.used[static_cast<std::size_t>(k)] == 0) return Motion::Other;
  return along > 9 * turning ? Motion::Straight : turning > 0.64 * along ? Motion::Turning : Motion::Other;
}

struct TwistSums {
  double reference = 0, wheels = 0;            // |F_xy|, |Wt_xy| where it drives straight
  Complex across = 0;                          // F_xy conj(Wt_xy) there
  double both = 0, own = 0;                    // F_w Wt_w, Wt_w^2 where it turns
  double any_both = 0, any_own = 0, path = 0;  // the same wherever it moves, and |Wt_xy|^2
  Index straight = 0, turning = 0;
};

TwistSums twist_sums(const RobotView& robot, const DriveSet& drives) {
  TwistSums sums;
  drives.visit([&](std::size_t, const Drive& d) {
    for (Index k = 0; k < d.samples(); ++k) {
      const Motion motion = motion_of(robot, d, k);
      if (d.used[static_cast<std::size_t>(k)] != 0) {
        sums.any_both += d.w[k] * d.twist(k, 2);
        sums.any_own += d.twist(k, 2) * d.twist(k, 2);
        sums.path += d.twist(k, 0) * d.twist(k, 0) + d.twist(k, 1) * d.twist(k, 1);
      }
      if (motion == Motion::Straight) {
        const Complex f(d.fx[k], d.fy[k]), wheels(d.twist(k, 0), d.twist(k, 1));
        sums.reference += std::sqrt(std::norm(f));
        sums.wheels += std::sqrt(std::norm(wheels));
        sums.across += f * std::conj(wheels);
        ++sums.straight;
      } else if (motion == Motion::Turning) {
        sums.both += d.w[k] * d.twist(k, 2);
        sums.own += d.twist(k, 2) * d.twist(k, 2);
        ++sums.turning;
      }
    }
  });
  return sums;
}

struct NamedFactor {
  double factor;
  const char* name;
  const char* text;
};
constexpr NamedFactor kNames[] = {
    {60 / (2 * kPi), "rpm", "wheel speeds in revolutions per minute instead of rad/s"},
    {1 / (2 * kPi), "rev/s", "wheel speeds in revolutions per second instead of rad/s"},
    {180 / kPi, "deg/s", "wheel speeds in degrees per second instead of rad/s"},
    {2, "diameter", "diameters entered as radii"},
    {0.5, "half_radius", "radii entered half as large as they are"},
    {1000, "thousandth", "the reference in km, or radii in mm"},
    {0.001, "thousand", "the reference in mm, or stamps in ms"},
};

const NamedFactor* name_of_factor(double kv) {
  const NamedFactor* nearest = nullptr;
  for (const NamedFactor& one : kNames)
    if (std::abs(std::log(kv * one.factor)) < kNamed &&
        (nearest == nullptr ||
         std::abs(std::log(kv * one.factor)) < std::abs(std::log(kv * nearest->factor))))
      nearest = &one;
  return nearest;
}

Finding factor_finding(double kv, bool stamps) {
  const std::string how =
      fmt::format("the reference moves {:.3g} times as fast as nominal radii and wheel speeds say", kv);
  if (stamps) return finding_of("time_unit", how + ": the stamps look like milliseconds", {{"factor", kv}});
  const NamedFactor* name = name_of_factor(kv);
  Finding f = finding_of("common_factor", how, {{"factor", kv}});
  if (name == nullptr) return f;
  f.message += fmt::format(": {}?", name->text);
  f.figures["unit_factor"] = name->factor;
  f.severity = Severity::Error;
  // What is to be changed is not sure for the other two.
  f.mendable = name->factor != 1000 && name->factor != 0.001;
  return f;
}

void correct_factor(const RobotView& robot, DriveSet& drives, double kv, bool stamps) {
  drives.correct([&robot, kv, stamps](Drive& d) {
    if (stamps) {
      d.t *= 1000;
      if (!d.increments) d.motion *= 1000;
      update_stamps(d);
      update_reference(d);
    } else {
      d.motion *= kv;
    }
    update_wheels(robot, d);
    update_twist(robot, d);
    update_sums(robot, d);
  });
}

// 1000, 100 or 39.37 where turns fit and distances are as many times too long, else 1: lines may outweigh
// turns so far that the misfit does not show it.
double position_unit(const RobotView& robot, const TwistSums& sums, double kv) {
  constexpr double kTurns = 1e-3;  // of the squares
  if (!(robot.distance * robot.distance * sums.any_own > kTurns * sums.path)) return 1;
  if (!(std::abs(std::log(std::abs(sums.any_both / sums.any_own))) < kNamed)) return 1;
  for (const double unit : {1000.0, 100.0, kInches})
    if (std::abs(std::log(kv / unit)) < kNamed) return unit;
  return 1;
}

Finding position_finding(double unit, double kv) {
  return finding_of(
      "position_unit",
      fmt::format("x and y look like {} (factor {:.4g}): distances are {:.3g} times as long as the wheels "
                  "say while turns fit",
                  unit == 1000  ? "millimetres"
                  : unit == 100 ? "centimetres"
                                : "inches",
                  unit, kv),
      {{"factor", unit}});
}

void correct_positions(const RobotView& robot, DriveSet& drives, double unit) {
  drives.correct([&robot, unit](Drive& d) {
    d.x /= unit;
    d.y /= unit;
    update_reference(d);
    update_sums(robot, d);
  });
}

// Parameters that may be as far off as this do not make a finding.
bool box_allows_rotation(const RobotView& robot) {
  for (const BoundParameter& p : robot.robot->table.parameters)
    for (const Binding& b : p.bindings)
      if (b.field == WheelField::Y && p.parameter.unit == "ratio" && p.parameter.lower < p.parameter.upper)
        return true;
  return false;
}

// Half the angle of each wheel's direction against its velocity where it drives straight, median over the
// recordings. Not-a-number for wheels that slide or say nothing.
Vector direction_angles(const RobotView& robot, const DriveSet& drives) {
  const auto count = static_cast<Index>(robot.wheels.size());
  Vector angles = Vector::Constant(count, std::nan(""));
  std::vector<std::vector<double>> each(robot.wheels.size());
  drives.visit([&](std::size_t, const Drive& d) {
    for (Index i = 0; i < count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const WheelView& wheel = robot.wheels[at];
      if (!wheel.states() || wheel.nominal.slides) continue;
      const WheelVelocity u = velocity_of(robot, d, at);
      Complex sum = 0;
      Index samples = 0;
      for (Index k = 0; k < d.samples(); ++k) {
        if (motion_of(robot, d, k) != Motion::Straight) continue;
        const Complex own = Complex(u.x[k], u.y[k]) * Complex(d.c(k, i), -d.s(k, i));
        sum += own * own;
        ++samples;
      }
      if (samples >= kFewestSamples) each[at].push_back(0.5 * std::arg(sum));
    }
  });
  for (Index i = 0; i < count; ++i)
    if (const auto at = static_cast<std::size_t>(i); !each[at].empty()) angles[i] = median(each[at]);
  return angles;
}

double spread_of(const Vector& angles, double& largest) {
  double low = 1e9, high = -1e9;
  largest = 0;
  for (const double a : angles) {
    if (!std::isfinite(a)) continue;
    low = std::min(low, a);
    high = std::max(high, a);
    largest = std::max(largest, std::abs(a));
  }
  return high - low;
}

// Without the sign of a zero.
double tenths(double value) {
  return std::round(10 * value) / 10 + 0.0;
}

std::string in_degrees(const Vector& angles, double factor) {
  std::vector<std::string> text;
  for (const double a : angles)
    if (std::isfinite(a)) text.push_back(fmt::format("{:+.1f}", tenths(factor * a / kDegree)));
  return fmt::format("{}", fmt::join(text, ", "));
}

void turn_heading(DriveSet& drives, double beta) {
  drives.correct([beta](Drive& d) {
    d.theta.array() += beta;
    update_reference(d);
  });
}

Finding turned_finding(const RobotView& robot, double beta) {
  Finding f =
      finding_of("heading_turned",
                 fmt::format("the reference heading is turned by {:+.2g} deg against the direction of travel",
                             -beta / kDegree),
                 {{"angle", -beta}});
  if (robot.free(WheelField::Zero)) f.severity = Severity::Note;  // turning all zeros is the same
  return f;
}

Finding zero_finding(const RobotView& robot, const Vector& angles, double beta) {
  Finding f = finding_of(
      "steering_zero",
      fmt::format("steering zeros look off by {} deg (reading minus true)", in_degrees(angles, -1)));
  if (std::abs(beta) > kAngle) {
    f.message += fmt::format("; or the reference heading is turned by {:+.1f} deg and they differ by less",
                             tenths(-beta / kDegree));
    f.figures["turned"] = -beta;
  }
  for (std::size_t i = 0; i < robot.wheels.size(); ++i) {
    const double a = angles[static_cast<Index>(i)];
    if (!std::isfinite(a)) continue;
    f.figures[fmt::format("offset_{}", i + 1)] = -a;
    if (robot.wheels[i].steering >= 0 &&
        (f.wheel == 0 || std::abs(a) > std::abs(angles[static_cast<Index>(f.wheel - 1)])))
      f.wheel = i + 1;
  }
  if (robot.free(WheelField::Zero)) f.severity = Severity::Note;  // the calibration finds them
  return f;
}

void correct_zeros(const RobotView& robot, DriveSet& drives, const Vector& angles) {
  drives.correct([&robot, angles](Drive& d) {
    for (std::size_t i = 0; i < robot.wheels.size(); ++i) {
      const WheelView& wheel = robot.wheels[i];
      const double a = angles[static_cast<Index>(i)];
      if (wheel.steering >= 0 && std::isfinite(a) && wheel.nominal.gain != 0)
        d.angle.col(wheel.steering).array() += a / wheel.nominal.gain;
    }
    update_wheels(robot, d);
    update_twist(robot, d);
  });
}

struct Lever {
  double wx = 0, wy = 0, ww = 0, before = 0;
  Index samples = 0;
  double x() const { return wx / ww; }
  double y() const { return wy / ww; }
  bool shows() const {
    return samples >= kFewestSamples && ww > 0 && std::hypot(x(), y()) > kLever &&
           (wx * wx + wy * wy) / ww > 0.5 * before;
  }
};

void add_to(Lever& lever, const RobotView& robot, const Drive& d) {
  for (Index k = 0; k < d.samples(); ++k) {
    if (motion_of(robot, d, k) != Motion::Turning) continue;
    const double ex = d.fx[k] - d.twist(k, 0), ey = d.fy[k] - d.twist(k, 1);
    lever.wx += ey * d.w[k];
    lever.wy -= ex * d.w[k];
    lever.ww += d.w[k] * d.w[k];
    lever.before += ex * ex + ey * ey;
    ++lever.samples;
  }
}

// Two wheels side by side of unequal radii roll off centre when they turn the robot, as if the tracked point
// stood beside it: whether none of it is left with the radii that the wheels themselves show (their slopes).
bool radii_explain(const RobotView& robot, const DriveSet& drives) {
  std::vector<std::size_t> driven;
  for (std::size_t i = 0; i < robot.wheels.size(); ++i)
    if (robot.wheels[i].driven()) driven.push_back(i);
  if (driven.size() != 2 || robot.steerings() > 0 || !robot.free(WheelField::Radius)) return false;
  Sums sums(robot.wheels.size());
  drives.visit([&](std::size_t, const Drive& d) { sums += d.sums; });
  const SlopeFit fit = slope_fit(robot, sums);
  Lever left;
  drives.visit([&](std::size_t, const Drive& d) {
    Drive tried = d;
    for (const std::size_t i : driven)
      if (const double k = fit.slope[static_cast<Index>(i)]; std::isfinite(k) && k > 0)
        for (const auto& [column, weight] : robot.wheels[i].drives) tried.motion.col(column) *= k;
    update_wheels(robot, tried);
    update_twist(robot, tried);
    add_to(left, robot, tried);
  });
  return !left.shows();
}

void check_tracked_point(const RobotView& robot, DriveSet& drives, std::vector<Finding>& found) {
  Lever lever;
  drives.visit([&](std::size_t, const Drive& d) { add_to(lever, robot, d); });
  if (!lever.shows()) return;
  const double x = lever.x(), y = lever.y();
  found.push_back(finding_of("tracked_point",
                             fmt::format("the tracked point looks displaced by ({:.1f}, {:.1f}) cm",
                                         tenths(100 * x), tenths(100 * y)),
                             {{"x", x}, {"y", y}}));
  // Where the box of the wheels' places is as wide, the calibration finds it.
  double allowed = 0;
  for (const BoundParameter& p : robot.robot->table.parameters)
    for (const Binding& b : p.bindings)
      if (b.field == WheelField::X && !robot.from_origin)
        allowed = std::max(allowed, std::min(p.parameter.upper - p.parameter.nominal,
                                             p.parameter.nominal - p.parameter.lower));
  if (std::hypot(x, y) < allowed || radii_explain(robot, drives)) found.back().severity = Severity::Note;
  drives.correct([x, y](Drive& d) {
    d.fx += y * d.w;
    d.fy -= x * d.w;
  });
}

}  // namespace

std::vector<Finding> check_starts(const RobotView& robot, const DriveSet& drives) {
  if (!robot.from_origin) return {};
  double far = 0;
  std::size_t count = 0;
  drives.visit([&](std::size_t, const Drive& d) {
    const Reference& reference = d.recording->reference;
    if (!d.dense && (reference.sample.empty() || reference.sample.front() != 0)) return;
    const double distance = d.dense ? std::hypot(d.x[0], d.y[0]) : std::hypot(reference.x[0], reference.y[0]);
    far = std::max(far, distance);
    if (distance > kStart) ++count;
  });
  if (count == 0) return {};
  return {
      finding_of("start_offset",
                 fmt::format("{} of {} drives start up to {:.3g} m from the origin: align every drive to its "
                             "first pose",
                             count, drives.size(), far),
                 {{"largest", far}, {"drives", static_cast<double>(count)}})};
}

std::vector<Finding> check_factors(const RobotView& robot, DriveSet& drives) {
  std::vector<Finding> found;
  const TwistSums sums = twist_sums(robot, drives);
  const bool straight = sums.straight >= kFewestSamples && sums.wheels > 0;
  const bool turning = sums.turning >= kFewestSamples && sums.own > 0;
  if (!straight && !turning) return found;
  const double kw = turning ? sums.both / sums.own : 1,
               kv = straight ? sums.reference / sums.wheels : std::abs(kw);
  if (!(kv > 0)) return found;
  if (const double unit = position_unit(robot, sums, kv); unit > 1) {
    found.push_back(position_finding(unit, kv));
    correct_positions(robot, drives, unit);
    return found;
  }
  if (std::abs(std::log(kv)) > std::log(kFactor)) {
    const bool stamps = drives.first_step() < 0.002 && std::abs(std::log(kv / 1000)) < kNamed;
    found.push_back(factor_finding(kv, stamps));
    correct_factor(robot, drives, kv, stamps);
  }
  if (!straight || !turning || !(kw > 0) || box_allows_rotation(robot)) return found;
  if (!(std::abs(std::log(kw / kv)) > std::log(kFactor))) return found;
  found.push_back(finding_of(
      "rotation_factor",
      fmt::format("rotation is {:.3g} of what nominal geometry says while distances fit: half track, wheel "
                  "base or slipping turns",
                  kw / kv),
      {{"factor", kw / kv}}));
  return found;
}

std::vector<Finding> check_frames(const RobotView& robot, DriveSet& drives) {
  std::vector<Finding> found;
  const Vector angles = direction_angles(robot, drives);
  if (angles.array().isFinite().any()) {
    const TwistSums sums = twist_sums(robot, drives);
    double beta = std::arg(sums.across), largest = 0;
    beta -= kPi * std::round(beta / kPi);
    const double apart = spread_of(angles, largest), allowed = std::max(kSpread, 0.3 * std::abs(beta));
    if (std::abs(beta) > kAngle && apart <= allowed) {
      found.push_back(turned_finding(robot, beta));
      turn_heading(drives, beta);
    } else if (largest > kAngle && apart > allowed) {
      found.push_back(zero_finding(robot, angles, beta));
      correct_zeros(robot, drives, angles);
    }
  }
  check_tracked_point(robot, drives, found);
  return found;
}

}  // namespace odobench::inspection
