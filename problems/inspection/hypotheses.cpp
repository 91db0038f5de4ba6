#include "problems/inspection/hypotheses.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "base/angle.hpp"

namespace odobench::inspection {
namespace {

constexpr double kFits = 0.06;  // no explanation is looked for below it
constexpr double kExplains = 1.0 / 3;
constexpr double kBackwards = -0.3;
constexpr double kClearly = 0.9;           // of a score: less is a better explanation, more a like one
constexpr std::size_t kMostExchanged = 6;  // 719 permutations

// A fault, how well the data fit without it, and how to take it out of a drive.
struct Explanation {
  SlopeFit fit;
  std::vector<Finding> findings;
  std::function<void(Drive&)> correct;
};

void keep_better(std::optional<Explanation>& best, Explanation one) {
  if (!best || one.fit.score < best->fit.score) best = std::move(one);
}

std::string change(const SlopeFit& before, const SlopeFit& after) {
  return fmt::format(" (misfit {:.3g} -> {:.3g})", before.misfit, after.misfit);
}

std::map<std::string, double> both_misfits(const SlopeFit& before, const SlopeFit& after) {
  return {{"misfit", before.misfit}, {"misfit_without", after.misfit}};
}

void refresh(const RobotView& robot, Drive& d) {
  update_reference(d);
  update_wheels(robot, d);
}

// E and score where this is done to every drive first.
SlopeFit fit_after(const RobotView& robot, const DriveSet& drives, void (*apply)(Drive&)) {
  Sums sums(robot.wheels.size());
  drives.visit([&](std::size_t, const Drive& drive) {
    Drive tried = drive;
    apply(tried);
    refresh(robot, tried);
    update_sums(robot, tried);
    sums += tried.sums;
  });
  return slope_fit(robot, sums);
}

// Units and signs of whole columns: every candidate is tried on a copy.
void try_units(const RobotView& robot, const DriveSet& drives, const SlopeFit& now,
               std::optional<Explanation>& best) {
  struct Unit {
    const char* kind;
    const char* text;
    double factor;
    void (*apply)(Drive&);
  };
  static const Unit kUnits[] = {
      {"heading_degrees", "theta looks like degrees (factor 180/pi)", 1 / kDegree,
       [](Drive& d) { d.theta *= kDegree; }},
      {"heading_sign", "theta looks clockwise", -1, [](Drive& d) { d.theta *= -1; }},
      {"position_unit", "x and y look like millimetres (factor 1000)", 1000,
       [](Drive& d) { d.x /= 1000, d.y /= 1000; }},
      {"position_unit", "x and y look like centimetres (factor 100)", 100,
       [](Drive& d) { d.x /= 100, d.y /= 100; }},
      {"position_unit", "x and y look like inches (factor 39.37)", kInches,
       [](Drive& d) { d.x /= kInches, d.y /= kInches; }},
      {"steering_degrees", "steering angles look like degrees (factor 180/pi)", 1 / kDegree,
       [](Drive& d) { d.angle *= kDegree; }},
  };
  for (const Unit& unit : kUnits) {
    if (std::string_view(unit.kind) == "steering_degrees" && robot.steerings() == 0) continue;
    const SlopeFit fit = fit_after(robot, drives, unit.apply);
    std::map<std::string, double> figures = both_misfits(now, fit);
    figures["factor"] = unit.factor;
    keep_better(best, {fit, {finding_of(unit.kind, unit.text + change(now, fit), figures)}, unit.apply});
  }
}

// The driven wheels, where they are alike, so that their columns may be exchanged.
std::vector<std::size_t> alike(const RobotView& robot) {
  std::vector<std::size_t> driven;
  for (std::size_t i = 0; i < robot.wheels.size(); ++i) {
    const WheelView& w = robot.wheels[i];
    if (!w.driven()) continue;
    if (w.drives.size() != 1) return {};
    if (!driven.empty()) {
      const WheelView& first = robot.wheels[driven.front()];
      if ((first.steering < 0) != (w.steering < 0) || first.nominal.slides != w.nominal.slides ||
          (w.steering >= 0 && first.nominal.mount != w.nominal.mount))
        return {};
    }
    driven.push_back(i);
  }
  if (driven.size() < 2 || driven.size() > kMostExchanged) return {};
  return driven;
}

// "front left" as the customary letters, where each wheel stands in a quadrant of its own.
std::string quadrants(const RobotView& robot, const std::vector<std::size_t>& order) {
  std::vector<std::string> names;
  for (const std::size_t i : order) {
    const Wheel& w = robot.wheels[i].nominal;
    if (w.x == 0 || w.y == 0) return "";
    names.push_back(fmt::format("{}{}", w.x > 0 ? 'F' : 'R', w.y > 0 ? 'L' : 'R'));
    if (std::count(names.begin(), names.end(), names.back()) > 1) return "";
  }
  return fmt::format(" ({})", fmt::join(names, ", "));
}

Finding order_finding(const RobotView& robot, const std::vector<std::size_t>& driven,
                      const std::vector<std::size_t>& columns, const SlopeFit& now, const SlopeFit& fit) {
  // Wheel driven[i] takes the column of driven[columns[i]]; said is what each column holds.
  std::vector<std::size_t> holds(driven.size()), numbers(driven.size()), own(driven.size());
  for (std::size_t i = 0; i < driven.size(); ++i) holds[columns[i]] = driven[i];
  std::map<std::string, double> figures = both_misfits(now, fit);
  for (std::size_t i = 0; i < driven.size(); ++i) {
    own[i] = driven[i] + 1;
    numbers[i] = holds[i] + 1;
    figures[fmt::format("column_{}", own[i])] = static_cast<double>(numbers[i]);
  }
  return finding_of("wheel_order",
                    fmt::format("the columns of wheels {} hold wheels {}{}{}", fmt::join(own, ", "),
                                fmt::join(numbers, ", "), quadrants(robot, holds), change(now, fit)),
                    figures);
}

void try_orders(const RobotView& robot, const DriveSet& drives, const Sums& sums, const SlopeFit& now,
                std::optional<Explanation>& best) {
  const std::vector<std::size_t> driven = alike(robot);
  if (driven.empty()) return;
  const Matrix both = exchange_sums(robot, drives);
  std::vector<std::size_t> columns(driven.size());
  std::iota(columns.begin(), columns.end(), std::size_t{0});
  std::vector<std::size_t> least;
  SlopeFit lowest;
  while (std::next_permutation(columns.begin(), columns.end())) {
    Sums tried = sums;
    for (std::size_t i = 0; i < driven.size(); ++i) {
      const auto to = static_cast<Index>(driven[i]), from = static_cast<Index>(driven[columns[i]]);
      const double radii =
          robot.wheels[driven[i]].nominal.radius / robot.wheels[driven[columns[i]]].nominal.radius;
      tried.both[to] = both(to, from) * radii;
      tried.own[to] = sums.own[from] * radii * radii;
    }
    const SlopeFit fit = slope_fit(robot, tried);
    if (!least.empty() && !(fit.score < lowest.score)) continue;
    least = columns;
    lowest = fit;
  }
  const auto correct = [&robot, driven, least](Drive& d) {
    const Matrix motion = d.motion, angle = d.angle;
    for (std::size_t i = 0; i < driven.size(); ++i) {
      const WheelView &to = robot.wheels[driven[i]], &from = robot.wheels[driven[least[i]]];
      d.motion.col(to.drives.front().first) = motion.col(from.drives.front().first);
      if (to.steering >= 0) d.angle.col(to.steering) = angle.col(from.steering);
    }
  };
  keep_better(best, {lowest, {order_finding(robot, driven, least, now, lowest)}, correct});
}

void try_steering_signs(const RobotView& robot, const DriveSet& drives, const Sums& sums, const SlopeFit& now,
                        std::optional<Explanation>& best) {
  const Index steerings = robot.steerings();
  if (steerings == 0 || steerings > 8) return;
  Sums other(robot.wheels.size());
  drives.visit([&](std::size_t, const Drive& drive) {
    Drive turned = drive;
    turned.angle *= -1;
    update_wheels(robot, turned);
    update_sums(robot, turned);
    other += turned.sums;
  });
  for (unsigned set = 1; set < (1U << steerings); ++set) {
    Sums tried = sums;
    std::vector<std::size_t> wheels;
    for (std::size_t i = 0; i < robot.wheels.size(); ++i) {
      const Index steering = robot.wheels[i].steering;
      if (steering < 0 || (set >> steering & 1U) == 0) continue;
      const auto at = static_cast<Index>(i);
      tried.both[at] = other.both[at];
      tried.own[at] = other.own[at];
      wheels.push_back(i);
    }
    const SlopeFit fit = slope_fit(robot, tried);
    Explanation one{fit, {}, [set](Drive& d) {
                      for (Index i = 0; i < d.angle.cols(); ++i)
                        if ((set >> i & 1U) != 0) d.angle.col(i) *= -1;
                    }};
    for (const std::size_t i : wheels) {
      one.findings.push_back(finding_of(
          "steering_sign", robot.wheels[i].steering_label + " counts the other way" + change(now, fit),
          both_misfits(now, fit)));
      one.findings.back().wheel = i + 1;
      one.findings.back().signal = robot.wheels[i].nominal.steering;
    }
    keep_better(best, std::move(one));
  }
}

// Left-handed frames. Wheels exchanged or steering that counts the other way may be as good an explanation:
// these say it then, too.
void try_mirrors(const RobotView& robot, const DriveSet& drives, const SlopeFit& now,
                 std::optional<Explanation>& best) {
  struct Mirror {
    int which;  // as mend.cpp undoes it
    const char* text;
    void (*apply)(Drive&);
  };
  static const Mirror kMirrors[] = {
      {1, "y looks mirrored: it grows to the right, while theta counts to the left",
       [](Drive& d) { d.y *= -1; }},
      {2, "x and y look exchanged (or theta counts clockwise from y, as a compass does)",
       [](Drive& d) { d.x.swap(d.y); }},
      {3, "the frame looks mirrored: y grows to the right and theta counts clockwise (z down?)",
       [](Drive& d) { d.y *= -1, d.theta *= -1; }},
  };
  for (const Mirror& mirror : kMirrors) {
    const SlopeFit fit = fit_after(robot, drives, mirror.apply);
    if (best && fit.score > kClearly * best->fit.score) {
      if (mirror.which == 3 && fit.score < best->fit.score / kClearly)
        for (Finding& f : best->findings) f.message += "; or the frame is mirrored, y to the right";
      continue;
    }
    std::map<std::string, double> figures = both_misfits(now, fit);
    figures["mirror"] = mirror.which;
    best = Explanation{
        fit, {finding_of("frame_mirrored", mirror.text + change(now, fit), figures)}, mirror.apply};
  }
}

void check_backwards(const RobotView& robot, DriveSet& drives, std::vector<Finding>& found) {
  const SlopeFit fit = slope_fit(robot, sums_of(robot, drives));
  std::vector<double> sizes;
  for (const double k : fit.slope)
    if (std::isfinite(k)) sizes.push_back(std::abs(k));
  const double usual = median(sizes);
  std::vector<std::size_t> wheels;
  for (std::size_t i = 0; i < robot.wheels.size(); ++i)
    if (fit.slope[static_cast<Index>(i)] < kBackwards * usual) wheels.push_back(i);
  if (wheels.empty()) return;
  const bool all = wheels.size() == sizes.size();
  for (const std::size_t i : wheels) {
    const double k = fit.slope[static_cast<Index>(i)];
    drives.correct([&robot, i](Drive& d) {
      for (const auto& [column, weight] : robot.wheels[i].drives) d.motion.col(column) *= -1;
    });
    if (all) continue;
    found.push_back(
        finding_of("wheel_reversed",
                   fmt::format("{} rolls against the reference (slope {:.3g})", robot.wheels[i].label, k),
                   {{"slope", k}}));
    found.back().wheel = i + 1;
  }
  if (all)
    found.push_back(finding_of(
        "direction_reversed",
        fmt::format(
            "all wheels roll against the reference (slopes about {:.3g}): the robot drives backwards, or "
            "its frame is turned by pi",
            -usual),
        {{"slope", -usual}}));
}

}  // namespace

Sums sums_of(const RobotView& robot, DriveSet& drives) {
  Sums sums(robot.wheels.size());
  drives.correct([&robot](Drive& d) { update_sums(robot, d); });
  drives.visit([&](std::size_t, const Drive& d) { sums += d.sums; });
  return sums;
}

Matrix exchange_sums(const RobotView& robot, const DriveSet& drives) {
  const auto count = static_cast<Index>(robot.wheels.size());
  Matrix both = Matrix::Zero(count, count);
  drives.visit([&](std::size_t, const Drive& d) {
    Vector mask(d.samples());
    for (Index k = 0; k < d.samples(); ++k) mask[k] = d.used[static_cast<std::size_t>(k)];
    for (Index i = 0; i < count; ++i) {
      const auto wheel = static_cast<std::size_t>(i);
      if (!robot.wheels[wheel].driven()) continue;
      const WheelVelocity u = velocity_of(robot, d, wheel);
      for (Index j = 0; j < count; ++j) {
        const auto other = static_cast<std::size_t>(j);
        if (!robot.wheels[other].driven()) continue;
        const Index points = robot.wheels[wheel].steering < 0 ? i : j;  // what is fixed keeps its direction
        both(i, j) += (mask.array() * rolling_of(robot, d, other).array() *
                       (d.c.col(points).array() * u.x.array() + d.s.col(points).array() * u.y.array()))
                          .sum();
      }
    }
  });
  return both;
}

std::vector<Finding> check_hypotheses(const RobotView& robot, DriveSet& drives) {
  std::vector<Finding> found;
  const Sums sums = sums_of(robot, drives);
  const SlopeFit now = slope_fit(robot, sums);
  if (now.misfit > kFits) {
    std::optional<Explanation> best;
    try_units(robot, drives, now, best);
    try_orders(robot, drives, sums, now, best);
    try_steering_signs(robot, drives, sums, now, best);
    try_mirrors(robot, drives, now, best);
    if (best && best->fit.misfit < kExplains * now.misfit) {
      found = best->findings;
      drives.correct([&robot, correct = best->correct](Drive& d) {
        correct(d);
        refresh(robot, d);
      });
    }
  }
  const std::size_t before = found.size();
  check_backwards(robot, drives, found);
  if (found.size() > before) drives.correct([&robot](Drive& d) { update_wheels(robot, d); });
  return found;
}

}  // namespace odobench::inspection
