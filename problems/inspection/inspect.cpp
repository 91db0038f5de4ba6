#include "problems/inspection/inspect.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "problems/inspection/hypotheses.hpp"
#include "problems/inspection/recording_checks.hpp"
#include "problems/inspection/set_checks.hpp"

namespace odobench::inspection {
namespace {

constexpr double kMoved = 0.005;     // m
constexpr double kTurned = 0.01;     // m of a wheel's path
constexpr double kAsymmetric = 0.1;  // of the mean lengths

void append(std::vector<Finding>& to, const std::vector<Finding>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

double range_of(const std::vector<double>& v) {
  if (v.empty()) return 0;
  const auto [low, high] = std::minmax_element(v.begin(), v.end());
  return *high - *low;
}

// The robot stands in all recordings, as far as there are two poses to say so.
void check_moved(const RobotView& robot, const DriveSet& drives, std::vector<Finding>& found) {
  double largest = 0, path = 0;
  for (std::size_t i = 0; i < drives.size(); ++i) {
    const Reference& reference = drives.recording(i).reference;
    if (reference.x.size() < 2) return;
    largest = std::max(
        {largest, range_of(reference.x), range_of(reference.y), robot.distance * range_of(reference.theta)});
    if (largest >= kMoved) return;
  }
  drives.visit([&](std::size_t, const Drive& d) {
    for (Index k = 0; k < d.motion.rows(); ++k) path += wheel_path(robot, d, k);
  });
  found = {finding_of("never_moved",
                      fmt::format("the reference never moves{}: nothing can be calibrated",
                                  path > kTurned ? " though the wheels turn" : ", nor do the wheels"),
                      {{"range", largest}, {"rolled", path}})};
}

void check_layout(const RobotView& robot, std::vector<Finding>& found) {
  if (!robot.mean) return;
  double a = 0, b = 0, sizes_a = 0, sizes_b = 0;
  for (const WheelView& w : robot.wheels) {
    a += w.nominal.x;
    b += w.nominal.y;
    sizes_a += std::abs(w.nominal.x);
    sizes_b += std::abs(w.nominal.y);
  }
  if (std::abs(a) <= kAsymmetric * sizes_a && std::abs(b) <= kAsymmetric * sizes_b) return;
  const double wheels = static_cast<double>(robot.wheels.size());
  found.push_back(
      finding_of("layout_asymmetric",
                 fmt::format("the wheels' centre is ({:.3f}, {:.3f}) m from the origin: the mean velocity "
                             "(2.16)-(2.17) is not exact, use the least-squares velocity",
                             a / wheels, b / wheels),
                 {{"x", a / wheels}, {"y", b / wheels}}));
}

bool has(const std::vector<Finding>& found, std::string_view kind) {
  return std::any_of(found.begin(), found.end(), [&](const Finding& f) { return f.kind == kind; });
}

}  // namespace

std::vector<Finding> inspect(const Robot& own, std::span<const Recording> recordings, int threads,
                             std::size_t kept_samples) {
  const RobotView robot(own);
  std::vector<std::vector<Finding>> each(recordings.size());
  std::vector<char> dense(recordings.size(), 0), sparse(recordings.size(), 0);
  DriveSet drives(
      robot, recordings,
      [&](std::size_t i, Drive& d) {
        std::vector<Finding> one = check_recording(robot, d);
        if (dense[i] == 0 && sparse[i] == 0) {
          each[i] = std::move(one);
          (d.dense ? dense : sparse)[i] = 1;
        }
        if (!d.dense) return;
        update_reference(d);
        update_wheels(robot, d);
      },
      threads, kept_samples);
  if (!drives.keeps()) drives.visit_parallel([](std::size_t, const Drive&) {});  // findings of each
  std::vector<Finding> found;
  for (const std::vector<Finding>& one : each) append(found, one);
  check_moved(robot, drives, found);
  if (has(found, "never_moved")) return found;
  check_layout(robot, found);
  if (std::count(sparse.begin(), sparse.end(), 1) > 0) {
    DriveSet rest(
        robot, recordings, [](std::size_t, Drive&) {}, threads, kept_samples);
    rest.only(sparse);
    append(found, check_starts(robot, rest));
    drives.only(dense);
  }
  if (drives.size() == 0) return found;
  const std::size_t of_recordings = found.size();
  append(found, check_hypotheses(robot, drives));
  drives.correct([&robot](Drive& d) {
    update_twist(robot, d);
    update_sums(robot, d);
  });
  append(found, check_factors(robot, drives));
  append(found, check_starts(robot, drives));
  const bool rotation = has(found, "rotation_factor");
  append(found, check_lag(robot, drives));
  append(found, check_frames(robot, drives));
  append(found, check_recordings_alike(robot, drives, rotation));
  // Where nothing fits, what was seen on the way is no explanation.
  if (has(found, "not_together"))
    found.erase(found.begin() + static_cast<std::ptrdiff_t>(of_recordings), found.end() - 1);
  return found;
}

}  // namespace odobench::inspection
