#include "tests/support/data/coverage.hpp"

#include <cmath>
#include <stdexcept>

#include "base/angle.hpp"
#include "problems/trust/trust.hpp"
#include "problems/trust/twist_map.hpp"
#include "solvers/solve.hpp"

namespace odobench::testing {
namespace {

Vector truth_of(const Dataset& set) {
  for (const NamedParameters& known : set.known_parameters)
    if (known.name == "truth")
      return Eigen::Map<const Vector>(known.values.data(), static_cast<Eigen::Index>(known.values.size()));
  throw std::invalid_argument("the set does not know the truth");
}

void count(Held& held, double half_width, double error) {
  if (!std::isfinite(half_width)) {
    ++held.refused;
    return;
  }
  ++held.given;
  held.held += std::abs(error) <= half_width ? 1 : 0;
}

// The error at the end of a drive, as the intervals have it: x, y, heading.
double end_error(const CalibrationProblem& problem, std::size_t n, const Vector& z, const std::string& what) {
  const PoseTrack track = problem.integrate(n, z);
  const Reference& reference = problem.recordings()[n].reference;
  if (what == "x") return track.x.back() - reference.x.back();
  if (what == "y") return track.y.back() - reference.y.back();
  return wrapped_angle(track.theta.back() - reference.theta.back());
}

}  // namespace

Held& Held::operator+=(const Held& other) {
  given += other.given;
  held += other.held;
  refused += other.refused;
  return *this;
}

SetCoverage coverage_of(const Dataset& set, const Dataset& fresh, const CalibrationChoice& choice) {
  const CalibrationOptions options = calibration_options(set.robot, choice);
  const auto problem = std::make_shared<const CalibrationProblem>(set.robot, set.recordings, options);
  const Problem handle(problem);
  const Vector z = solve(handle, {"lm", {}}, handle.start(), {}).x, truth = truth_of(set);
  const RecordingCosts costs(set.robot, set.recordings, options);
  const Trust trust = assess_trust(costs, set.robot, z);
  const TwistMap map = twist_map(set.robot, problem->parameters(), truth);

  SetCoverage result;
  result.on_bounds = static_cast<int>(trust.active.size());
  result.rule_said = !trust.moved_by_rule.empty();
  result.systematic = trust.kind_test.systematic;
  for (const DeterminedNumber& d : trust.determined)
    for (const TwistNumber& true_number : map.numbers) {
      if (true_number.name != d.number.name) continue;
      const double error = d.number.value - true_number.value;
      count(result.determined[d.number.name], d.interval.half_width, error);
      count(result.same_drives[d.number.name], d.interval.same_half_width, error);
    }
  for (const ParameterInterval& p : trust.parameters)
    for (std::size_t i = 0; i < problem->parameters().size(); ++i)
      if (problem->parameters()[i].name == p.name)
        count(result.parameters, p.interval.half_width, p.value - truth[static_cast<Eigen::Index>(i)]);

  const CalibrationProblem unseen(set.robot, fresh.recordings, options);
  for (std::size_t n = 0; n < unseen.recordings().size(); ++n)
    for (const DriveError& e : trust.drives)
      if (e.drive == unseen.recordings()[n].trajectory)
        count(result.end_errors, e.interval.half_width, end_error(unseen, n, z, e.what));
  return result;
}

}  // namespace odobench::testing
