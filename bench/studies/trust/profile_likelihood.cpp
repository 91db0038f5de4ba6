#include "bench/studies/trust/profile_likelihood.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "base/parallel.hpp"
#include "base/text.hpp"
#include "bench/catalogue/option_values.hpp"
#include "problems/trust/combined_intervals.hpp"
#include "solvers/solve.hpp"

namespace odobench {
namespace {

using Eigen::Index;

// The calibration with one parameter held.
class HeldCalibration {
 public:
  HeldCalibration(std::shared_ptr<const CalibrationProblem> problem, std::size_t at, double value)
      : problem_(std::move(problem)), parameters_(problem_->parameters()) {
    parameters_[at].nominal = parameters_[at].lower = parameters_[at].upper = value;
  }
  std::string name() const { return problem_->name(); }
  const std::vector<ParameterInfo>& parameters() const { return parameters_; }
  double cost(const ConstVectorRef& z) const { return problem_->cost(z); }
  void normal_equations(const ConstVectorRef& z, NormalEquations& out) const {
    problem_->normal_equations(z, out);
  }
  void batch_cost(const ConstMatrixRef& candidates, VectorRef costs) const {
    problem_->batch_cost(candidates, costs);
  }
  double rounding_floor(const ConstVectorRef& z) const { return problem_->rounding_floor(z); }

 private:
  std::shared_ptr<const CalibrationProblem> problem_;
  std::vector<ParameterInfo> parameters_;
};

std::size_t place_of(const std::vector<ParameterInfo>& parameters, const std::string& name) {
  const auto at = std::find_if(parameters.begin(), parameters.end(),
                               [&](const ParameterInfo& p) { return p.name == name; });
  if (at == parameters.end())
    throw std::invalid_argument(fmt::format("profile: found no parameter '{}'", name));
  return static_cast<std::size_t>(at - parameters.begin());
}

}  // namespace

std::vector<ProfilePoint> profile_likelihood(std::shared_ptr<const CalibrationProblem> problem,
                                             const std::string& parameter, const std::vector<double>& values,
                                             const Vector& start, const std::string& solver) {
  const std::size_t at = place_of(problem->parameters(), parameter);
  const ParameterInfo& box = problem->parameters()[at];
  std::vector<ProfilePoint> points;
  Vector last = start;
  for (const double value : values) {
    if (!(value >= box.lower && value <= box.upper))
      throw std::invalid_argument(
          fmt::format("profile: {} = {}, expected {} .. {}", parameter, value, box.lower, box.upper));
    const Problem held(HeldCalibration(problem, at, value));
    ProfilePoint best{value, std::numeric_limits<double>::infinity(), {}};
    for (Vector from : {start, last}) {
      from[static_cast<Index>(at)] = value;
      const Result result = solve(held, {solver, {}}, from, {});
      if (result.usable() && result.cost < best.cost) best = {value, result.cost, result.x};
    }
    if (best.z.size() > 0) last = best.z;
    points.push_back(std::move(best));
  }
  return points;
}

ProfileEnds profile_ends(const std::vector<ProfilePoint>& points, double limit) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  ProfileEnds ends{kNone, -kNone};
  const auto crossing = [&](const ProfilePoint& a, const ProfilePoint& b) {
    return a.value + (limit - a.cost) / (b.cost - a.cost) * (b.value - a.value);
  };
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (!(points[k].cost <= limit)) continue;
    if (ends.lower == kNone) ends.lower = k == 0 ? -kNone : crossing(points[k - 1], points[k]);
    ends.upper = k + 1 == points.size() ? kNone : crossing(points[k], points[k + 1]);
  }
  return ends;
}

namespace {

// One side of a profile: fits from the result outwards.
class Side {
 public:
  Side(std::shared_ptr<const CalibrationProblem> problem, std::size_t at, const Vector& z, double limit,
       const Stop& stop)
      : problem_(std::move(problem)), at_(at), z_(z), limit_(limit), stop_(stop) {}

  // From the result towards `bound`, outwards.
  std::vector<ProfilePoint> walk(double cost, double bound, double reach, int steps) {
    constexpr int kFarther = 12;
    points_ = {{z_[static_cast<Index>(at_)], cost, z_}};
    const double from = points_.front().value, room = std::abs(bound - from);
    const double sign = bound < from ? -1 : 1;
    if (!(room > 0)) return {};
    const double far = std::isfinite(reach) ? std::min(reach, room) : room;
    for (int k = 1; k <= steps; ++k) fit(k == steps && far == room ? bound : from + sign * far * k / steps);
    double distance = far;
    for (int k = 0; k < kFarther && distance < room && points_.back().cost <= limit_; ++k) {
      distance = std::min(1.5 * distance, room);
      fit(distance == room ? bound : from + sign * distance);
    }
    find_end();
    return std::vector<ProfilePoint>(points_.begin() + 1, points_.end());
  }

 private:
  ProfilePoint fitted(double value, const Vector& neighbour) const {
    const Problem held(HeldCalibration(problem_, at_, value));
    ProfilePoint best{value, std::numeric_limits<double>::infinity(), {}};
    for (const Vector* start : {&neighbour, &z_}) {
      Vector from = *start;
      from[static_cast<Index>(at_)] = value;
      SolveOptions options;
      options.interrupt = stop_.flag();
      const Result result = solve(held, {"lm", {}}, from, options);
      stop_.check();
      if (result.usable() && result.cost < best.cost) best = {value, result.cost, result.x};
      if (result.termination == Termination::Converged) break;
    }
    return best;
  }
  void fit(double value) {
    const ProfilePoint point = fitted(value, points_.back().z);
    if (point.z.size() > 0) points_.push_back(point);
  }

  // Between the outermost point below the limit and the next: the root of sqrt(J_p - J*) - sqrt(rise), which
  // is nearly straight, by regula falsi with the weight of an end halved that stays (Illinois).
  void find_end() {
    constexpr int kMost = 12;
    constexpr double kClose = 1e-3;
    std::size_t k = points_.size();
    while (k > 0 && !(points_[k - 1].cost <= limit_)) --k;
    if (k == 0 || k == points_.size()) return;
    const double cost = points_.front().cost, rise = limit_ - cost;
    if (!(rise > 0)) return;
    const auto off = [&](const ProfilePoint& p) {
      return std::sqrt(std::max(p.cost - cost, 0.0)) - std::sqrt(rise);
    };
    double below = off(points_[k - 1]), above = off(points_[k]);
    for (int turn = 0, last = 0; turn < kMost; ++turn) {
      const ProfilePoint a = points_[k - 1], b = points_[k];
      const ProfilePoint middle = fitted(a.value - below / (above - below) * (b.value - a.value), a.z);
      if (middle.z.size() == 0 || middle.value == a.value || middle.value == b.value) return;
      points_.insert(points_.begin() + static_cast<std::ptrdiff_t>(k), middle);
      if (std::abs(middle.cost - limit_) <= kClose * rise) return;
      const int side = middle.cost <= limit_ ? -1 : 1;
      if (side < 0) {
        below = off(middle);
        if (last == side) above /= 2;
        ++k;
      } else {
        above = off(middle);
        if (last == side) below /= 2;
      }
      last = side;
    }
  }

  std::shared_ptr<const CalibrationProblem> problem_;
  std::size_t at_;
  const Vector& z_;
  double limit_;
  const Stop& stop_;
  std::vector<ProfilePoint> points_;
};

std::vector<std::size_t> places_asked(const std::vector<ParameterInfo>& parameters,
                                      const ProfileChoice& choice) {
  std::vector<bool> asked(parameters.size(), false);
  for (std::size_t i = 0; i < parameters.size(); ++i)
    asked[i] = choice.all && parameters[i].lower < parameters[i].upper;
  for (const std::string& name : choice.parameters) {
    const std::size_t at = place_of(parameters, name);
    if (!(parameters[at].lower < parameters[at].upper))
      throw std::invalid_argument(fmt::format(
          "profile: {} is held at {:g}, expected a parameter that is free", name, parameters[at].lower));
    asked[at] = true;
  }
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < asked.size(); ++i)
    if (asked[i]) places.push_back(i);
  return places;
}

}  // namespace

ProfileChoice profile_choice(const std::string& text, int steps) {
  ProfileChoice choice;
  choice.steps = steps;
  std::vector<std::string> names = comma_items(text);
  if (names.size() == 1 && names.front() == "all") {
    choice.all = true;
    return choice;
  }
  for (std::string& name : names) {
    if (std::find(choice.parameters.begin(), choice.parameters.end(), name) != choice.parameters.end())
      throw std::invalid_argument(fmt::format("--profile={}: found '{}' twice", shown(text), shown(name)));
    choice.parameters.push_back(std::move(name));
  }
  if (std::count(choice.parameters.begin(), choice.parameters.end(), "") > 0 || choice.parameters.empty())
    throw std::invalid_argument("--profile: found nothing, expected names of parameters, or all");
  return choice;
}

std::vector<ParameterProfile> profiles(const std::shared_ptr<const CalibrationProblem>& problem,
                                       const RecordingCosts& recordings, const ProfileChoice& choice,
                                       const Vector& z, int threads, Watcher& watcher, const Stop& stop) {
  const std::vector<std::size_t> places = places_asked(problem->parameters(), choice);
  const std::vector<RiseAlong> rises = rises_along(recordings, z);
  const double cost = problem->cost(z);
  std::vector<ParameterProfile> list(places.size());
  std::vector<std::vector<ProfilePoint>> sides(2 * places.size());
  std::vector<double> reach(places.size(), std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k < places.size(); ++k) {
    list[k].parameter = problem->parameters()[places[k]].name;
    for (const RiseAlong& one : rises)
      if (static_cast<std::size_t>(one.parameter) == places[k]) {
        list[k].rise = one.rise;
        list[k].reason = one.reason;
        if (one.refused == NoInterval::None) reach[k] = 2 * one.half_width;
      }
  }
  watcher.count_begins("sides of profiles", static_cast<std::int64_t>(sides.size()));
  parallel_for(
      sides.size(), threads,
      [&](std::size_t i) {
        const ParameterInfo& box = problem->parameters()[places[i / 2]];
        Side side(problem, places[i / 2], z, cost + list[i / 2].rise, stop);
        sides[i] = side.walk(cost, i % 2 == 0 ? box.lower : box.upper, reach[i / 2], choice.steps);
        watcher.count_one();
      },
      stop);
  watcher.count_ends();
  for (std::size_t k = 0; k < places.size(); ++k) {
    std::vector<ProfilePoint>& points = list[k].points;
    points.assign(sides[2 * k].rbegin(), sides[2 * k].rend());
    points.push_back({z[static_cast<Index>(places[k])], cost, z});
    points.insert(points.end(), sides[2 * k + 1].begin(), sides[2 * k + 1].end());
    if (std::isfinite(list[k].rise)) list[k].ends = profile_ends(points, cost + list[k].rise);
  }
  return list;
}

}  // namespace odobench
