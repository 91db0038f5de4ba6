#include "problems/trust/combined_intervals.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace odobench {

using Eigen::Index;

namespace {

constexpr double kInSpan = 1e-6;  // of the length of a gradient

void require_size(const std::vector<ParameterInfo>& parameters, const ConstVectorRef& z) {
  if (z.size() != static_cast<Index>(parameters.size()))
    throw std::invalid_argument(
        fmt::format("trust: {} parameters, expected {}", z.size(), parameters.size()));
}

// A formula at z, and at the nominal parameters.
struct Evaluated {
  Quantity at_z, at_nominal;
};

Evaluated evaluated(const Formula& formula, const std::vector<ParameterInfo>& parameters,
                    const std::vector<TwistNumber>& map, const ConstVectorRef& z) {
  const auto n = static_cast<Index>(parameters.size());
  std::vector<std::string> known;
  for (const ParameterInfo& p : parameters) known.push_back(p.name);
  for (const TwistNumber& number : map) known.push_back(number.name);
  const auto found = [&](const std::string& name, bool nominal) -> std::optional<Quantity> {
    for (Index i = 0; i < n; ++i) {
      const ParameterInfo& p = parameters[static_cast<std::size_t>(i)];
      if (p.name == name)
        return Quantity{nominal ? p.nominal : z[i], Vector::Unit(n, i), dimension_of(p.unit), false};
    }
    for (const TwistNumber& number : map)
      if (number.name == name)
        return Quantity{nominal ? number.nominal : number.value, number.gradient, dimension_of(number.unit),
                        false};
    return std::nullopt;
  };
  Evaluated out;
  out.at_z = evaluate(
      formula, [&](const std::string& name) { return found(name, false); }, known);
  if (out.at_z.gradient.size() == 0 || out.at_z.gradient.isZero(0))
    throw std::invalid_argument(
        fmt::format("'{}': it does not depend on any parameter here, expected one that does", formula.text));
  out.at_nominal = out.at_z;
  try {
    out.at_nominal = evaluate(
        formula, [&](const std::string& name) { return found(name, true); }, known);
  } catch (const std::invalid_argument&) {  // no finite number there, as 1/lever of a lever that is 0
    out.at_nominal.value = std::numeric_limits<double>::quiet_NaN();
  }
  return out;
}

// Places among scores.parameters of those on no bound.
std::vector<Index> free_places(const RecordingScores& scores, const std::vector<ParameterInfo>& parameters,
                               const ConstVectorRef& z) {
  std::vector<Index> places;
  for (Index k = 0; k < static_cast<Index>(scores.parameters.size()); ++k) {
    const Index at = scores.parameters[static_cast<std::size_t>(k)];
    if (!on_bound(parameters[static_cast<std::size_t>(at)], z[at])) places.push_back(k);
  }
  return places;
}

Vector by_q(const RecordingScores& scores, const Vector& gradient) {
  return scores.scale.cwiseProduct(Vector(gradient(scores.parameters)));
}

bool in_span(const Vector& c, const std::vector<TwistNumber>& map, const RecordingScores& scores) {
  if (map.empty()) return false;
  Matrix columns(c.size(), static_cast<Index>(map.size()));
  for (Index k = 0; k < columns.cols(); ++k)
    columns.col(k) = by_q(scores, map[static_cast<std::size_t>(k)].gradient);
  const Eigen::CompleteOrthogonalDecomposition<Matrix> factor(columns);
  return (c - columns * factor.solve(c)).norm() <= kInSpan * c.norm();
}

Interval refused(NoInterval why, std::string reason) {
  Interval none;
  none.refused = why;
  none.reason = std::move(reason);
  return none;
}

// Of what is not made of the map's numbers, as single parameters have it.
Interval as_single(const RecordingScores& scores, const RecordingCovariances& covariances,
                   const std::vector<ParameterInfo>& parameters, const Vector& c, bool any_active) {
  Interval found = jackknife_interval(scores, covariances, c);
  if (found.refused == NoInterval::TooFewRecordings || found.refused == NoInterval::OneRecording)
    return found;
  if (any_active) return refused(NoInterval::BoundActive, "decided by the box: a bound is active");
  if (found.refused == NoInterval::Undetermined)
    found.reason = "decided by the box: these drives cannot tell it";
  if (found.refused != NoInterval::None) return found;
  double box = 0;
  for (Index k = 0; k < c.size(); ++k) {
    const ParameterInfo& p =
        parameters[static_cast<std::size_t>(scores.parameters[static_cast<std::size_t>(k)])];
    box += std::abs(c[k]) * (p.upper - p.lower) / 2 / scores.scale[k];
  }
  if (found.half_width > box) {
    Interval none = refused(NoInterval::WiderThanBox,
                            fmt::format("decided by the box: the drives leave +- {:.3g}, the box +- {:.3g}",
                                        found.half_width, box));
    none.deviation = found.deviation;
    none.df = found.df;
    return none;
  }
  return found;
}

}  // namespace

Quantity formula_at(const Formula& formula, const Robot& robot, const std::vector<ParameterInfo>& parameters,
                    const ConstVectorRef& z) {
  require_size(parameters, z);
  return evaluated(formula, parameters, twist_map(robot, parameters, z).numbers, z).at_z;
}

std::vector<CombinationInterval> combination_intervals(const RecordingCosts& costs, const Robot& robot,
                                                       const ConstVectorRef& z,
                                                       const std::vector<Formula>& formulas) {
  const std::vector<ParameterInfo>& parameters = costs.parameters();
  require_size(parameters, z);
  const std::vector<TwistNumber> map = twist_map(robot, parameters, z).numbers;
  const RecordingScores scores = recording_scores(costs, z);
  std::vector<CombinationInterval> list;
  for (const Formula& formula : formulas) {
    const Evaluated value = evaluated(formula, parameters, map, z);
    CombinationInterval one{formula, "", value.at_nominal.value, value.at_z.value, false, {}};
    if (value.at_z.dimension) one.unit = unit_of(*value.at_z.dimension);
    const Vector c = by_q(scores, value.at_z.gradient);
    if (c.isZero(0))
      one.interval = refused(NoInterval::WiderThanBox, "no free parameter moves it");
    else
      one.of_the_map = in_span(c, map, scores);
    list.push_back(std::move(one));
  }
  if (scores.parameters.empty()) return list;
  const RecordingCovariances covariances(scores.g, scores.h);
  const std::vector<Index> places = free_places(scores, parameters, z);
  const RecordingScores free = restricted(scores, places);
  std::optional<LeaveOneOut> moves;
  for (CombinationInterval& one : list) {
    if (one.interval.refused != NoInterval::None) continue;
    const Vector c = by_q(scores, evaluated(one.formula, parameters, map, z).at_z.gradient);
    if (!one.of_the_map) {
      one.interval = as_single(scores, covariances, parameters, c, places.size() < scores.parameters.size());
      continue;
    }
    const Vector of_free = c(places);
    if (const Interval general = general_refusal(scores); general.refused != NoInterval::None) {
      one.interval = general;
    } else if (of_free.size() == 0 || of_free.isZero(0)) {
      one.interval = refused(NoInterval::BoundActive, "decided by the box: what moves it lies on bounds");
    } else {
      if (!moves)
        moves.emplace(
            free, exact_half_hessian([&](const Vector& at) { return half_gradient(costs, at); }, free, z));
      one.interval = moves->interval(of_free);
    }
  }
  return list;
}

std::vector<RiseAlong> rises_along(const RecordingCosts& costs, const ConstVectorRef& z) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  require_size(costs.parameters(), z);
  const RecordingScores scores = recording_scores(costs, z);
  std::vector<RiseAlong> list;
  if (scores.parameters.empty()) return list;
  const Interval general = general_refusal(scores);
  const std::vector<Index> free = free_places(scores, costs.parameters(), z);
  Matrix exact;
  if (general.refused == NoInterval::None)
    exact = exact_half_hessian([&](const Vector& at) { return half_gradient(costs, at); }, scores, z);
  for (Index k = 0; k < static_cast<Index>(scores.parameters.size()); ++k) {
    RiseAlong one{scores.parameters[static_cast<std::size_t>(k)], kNone, kNone, general.refused,
                  general.reason};
    if (one.refused == NoInterval::None) {
      std::vector<Index> places = free;
      const auto at = std::lower_bound(places.begin(), places.end(), k);
      const Index place = at - places.begin();
      if (at == places.end() || *at != k) places.insert(at, k);
      const RecordingScores some = restricted(scores, places);
      const LeaveOneOut moves(some, exact(places, places));
      const Vector c = Vector::Unit(static_cast<Index>(places.size()), place);
      const Interval found = moves.interval(c);
      one.refused = found.refused;
      one.reason = found.reason;
      if (found.refused == NoInterval::None) {
        const Matrix curvature = moves.uses_exact() ? Matrix(exact(places, places)) : some.information();
        one.rise = found.half_width * found.half_width / c.dot(curvature.ldlt().solve(c));
        one.half_width = found.half_width * scores.scale[k];
      }
    }
    list.push_back(std::move(one));
  }
  return list;
}

}  // namespace odobench
