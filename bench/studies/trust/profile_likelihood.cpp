#include "bench/studies/trust/profile_likelihood.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

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

}  // namespace odobench
