#include "problems/trust/trust.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "base/angle.hpp"
#include "problems/calibration/drive_errors.hpp"

namespace odobench {

using Eigen::Index;

namespace {

constexpr double kStraight = 10;        // m
constexpr double kNoticed = 0.5;        // of a half width
constexpr double kPoseStep = 1e-6;      // relative
constexpr std::size_t kManyKinds = 12;  // from which intervals may be taken between kinds

// Everything that several parts of the result are made of.
struct Setting {
  const RecordingCosts& costs;
  Vector z;
  RecordingScores scores;          // of all parameters whose bounds differ
  std::vector<Index> free_places;  // among them, those on no bound
  RecordingScores free;

  // c in q of the free parameters, from a gradient by z.
  Vector by_free(const Vector& gradient) const {
    return free.scale.cwiseProduct(Vector(gradient(free.parameters)));
  }
};

Setting prepare(const RecordingCosts& costs, const ConstVectorRef& z, Trust& trust) {
  Setting s{costs, z, recording_scores(costs, z), {}, {}};
  for (Index k = 0; k < static_cast<Index>(s.scores.parameters.size()); ++k) {
    const Index at = s.scores.parameters[static_cast<std::size_t>(k)];
    const ParameterInfo& p = costs.parameters()[static_cast<std::size_t>(at)];
    if (on_bound(p, z[at]))
      trust.active.push_back(p.name);
    else
      s.free_places.push_back(k);
  }
  s.free = restricted(s.scores, s.free_places);
  trust.recordings = s.scores.size();
  trust.kinds = kinds_of(s.scores.kinds).names.size();
  trust.free = s.free_places.size();
  return s;
}

// `units`: the recordings' scores, or those of kinds, with their covariances.
std::vector<ParameterInterval> parameter_intervals(const Setting& s, const RecordingScores& units,
                                                   const RecordingCovariances& covariances,
                                                   const std::vector<std::string>& active) {
  std::vector<ParameterInterval> list;
  for (Index k = 0; k < static_cast<Index>(s.scores.parameters.size()); ++k) {
    const Index at = s.scores.parameters[static_cast<std::size_t>(k)];
    const ParameterInfo& p = s.costs.parameters()[static_cast<std::size_t>(at)];
    ParameterInterval one{p.name, p.unit, s.z[at], (p.upper - p.lower) / 2, {}};
    const double scale = s.scores.scale[k];
    one.interval = jackknife_interval(units, covariances, Vector::Unit(s.scores.scale.size(), k));
    Interval& found = one.interval;
    found.deviation *= scale;
    found.half_width *= scale;
    const double wide = found.half_width;
    if (!active.empty() && found.refused != NoInterval::TooFewRecordings &&
        found.refused != NoInterval::OneRecording) {
      found.refused = NoInterval::BoundActive;
      found.reason = "decided by the box: a bound is active";
    } else if (found.refused == NoInterval::Undetermined) {
      found.reason = "decided by the box: these drives cannot tell it";
    } else if (found.refused == NoInterval::None && wide > one.box_half_width) {
      found.refused = NoInterval::WiderThanBox;
      found.reason = fmt::format("decided by the box: the drives leave +- {:.3g} %, the box +- {:.3g} %",
                                 100 * wide / scale, 100 * one.box_half_width / scale);
    }
    if (found.refused != NoInterval::None) found.half_width = std::numeric_limits<double>::quiet_NaN();
    list.push_back(std::move(one));
  }
  return list;
}

// Errors of driving 10 m and of a full turn: combinations of the numbers of the map.
void add_basic_drives(const Setting& s, const LeaveOneOut& moves, Trust& trust) {
  const auto gradient = [&](const std::string& name) {
    for (const DeterminedNumber& d : trust.determined)
      if (d.number.name == name) return d.number.gradient;
    return Vector(Vector::Zero(s.z.size()));
  };
  const auto add = [&](const std::string& drive, const char* what, const char* unit, const Vector& by_z) {
    if (by_z.isZero(0)) return;
    trust.drives.push_back({drive, what, unit, 0, moves.interval(s.by_free(by_z))});
  };
  // Along x by m11, aside by m21 and by the heading that grows with m31; the same along y.
  const double lever = kStraight * kStraight / 2;
  add("10 m along x", "along", "m", kStraight * gradient("m11"));
  add("10 m along x", "aside", "m", kStraight * gradient("m21") + lever * gradient("m31"));
  add("10 m along x", "heading", "rad", kStraight * gradient("m31"));
  add("10 m along y", "aside", "m", kStraight * gradient("m12") - lever * gradient("m32"));
  add("10 m along y", "heading", "rad", kStraight * gradient("m32"));
  add("full turn", "heading", "rad", 2 * kPi * gradient("m33"));
  add("full circle to the left", "heading", "rad", 2 * kPi * gradient("left_turn"));
  add("full circle to the right", "heading", "rad", 2 * kPi * gradient("right_turn"));
}

Eigen::Vector3d end_of(const PoseTrack& track) {
  return {track.x.back(), track.y.back(), track.theta.back()};
}

// Of a structured problem the last three residuals.
Eigen::Vector3d end_error(const Setting& s, std::size_t recording) {
  const CalibrationProblem& problem = s.costs[recording];
  if (!problem.structured()) return drive_errors(s.costs.recording(recording), problem.integrate(0, s.z)).end;
  Vector r(problem.residual_count());
  problem.residuals(s.z, r);
  return r.tail<3>();
}

// Gradients by z of the end pose of a recording (rows x, y, theta), of the parameters on no bound.
Matrix end_gradients(const Setting& s, std::size_t recording) {
  const CalibrationProblem& problem = s.costs[recording];
  Matrix all = Matrix::Zero(3, s.z.size());
  if (problem.structured()) {
    Vector r(problem.residual_count());
    Matrix j(problem.residual_count(), s.z.size());
    problem.residuals_and_jacobian(s.z, r, j);
    return j.bottomRows(3);
  }
  for (std::size_t k = 0; k < s.free.parameters.size(); ++k) {
    const Index at = s.free.parameters[k];
    const double step = kPoseStep * s.free.scale[static_cast<Index>(k)];
    Vector up = s.z, down = s.z;
    up[at] += step;
    down[at] -= step;
    all.col(at) = (end_of(problem.integrate(0, up)) - end_of(problem.integrate(0, down))) / (2 * step);
  }
  return all;
}

// Of each kind: the end pose of its first recording, and the scatter of all of them.
void add_kinds(const Setting& s, const LeaveOneOut& moves, Trust& trust) {
  const KindsOfDrives kinds = kinds_of(s.scores.kinds);
  Matrix squares = Matrix::Zero(3, static_cast<Index>(kinds.names.size()));
  for (std::size_t n = 0; n < s.costs.size(); ++n)
    squares.col(static_cast<Index>(kinds.of[n])) +=
        end_error(s, n).cwiseAbs2() / static_cast<double>(kinds.counts[kinds.of[n]]);
  for (std::size_t kind = 0; kind < kinds.names.size(); ++kind) {
    const auto first =
        static_cast<std::size_t>(std::find(kinds.of.begin(), kinds.of.end(), kind) - kinds.of.begin());
    const Matrix gradients = end_gradients(s, first);
    constexpr const char* kWhat[] = {"x", "y", "heading"};
    for (Index row = 0; row < 3; ++row) {
      const double scatter = std::sqrt(squares(row, static_cast<Index>(kind)));
      trust.drives.push_back({kinds.names[kind], kWhat[row], row < 2 ? "m" : "rad", scatter,
                              moves.interval(s.by_free(Vector(gradients.row(row).transpose())), scatter)});
    }
  }
}

// The first Newton step of the free parameters towards the optimum of the same J by arcs, where J is lower
// there: where it is not, the drives speak for Euler's rule (as simulated ones that were made by it do).
void add_rule_shifts(const Setting& s, const Robot& robot, const Matrix& exact, Trust& trust) {
  CalibrationOptions options = s.costs[0].options();
  if (options.rule != robots::IntegrationRule::Euler || options.cost != CostKind::EverySample) return;
  options.rule = robots::IntegrationRule::Arc;
  Vector gradient = Vector::Zero(s.z.size());
  NormalEquations e;
  double cost = 0;
  for (std::size_t n = 0; n < s.costs.size(); ++n) {
    CalibrationProblem(robot, {s.costs.recording(n)}, options).normal_equations(s.z, e);
    gradient += e.jtr;
    cost += e.cost;
  }
  const Vector slope = s.by_free(gradient);
  const Matrix curvature = trust.exact_hessian ? exact : s.free.information();
  const Vector moved = -curvature.ldlt().solve(slope);
  trust.cost_by_arcs = cost + slope.dot(moved);
  if (!(trust.cost_by_arcs < s.scores.cost())) return;
  for (const DeterminedNumber& d : trust.determined) {
    if (d.interval.refused != NoInterval::None) continue;
    const double shift = s.by_free(d.number.gradient).dot(moved);
    if (std::abs(shift) > kNoticed * d.interval.half_width)
      trust.moved_by_rule.push_back({d.number.name, d.number.words, shift, d.interval.half_width});
  }
}

Interval decided_by_the_box() {
  Interval none;
  none.refused = NoInterval::BoundActive;
  none.reason = "decided by the box: what moves it lies on bounds";
  return none;
}

// What counts as one observation: kinds of drive where their errors repeat and there are enough of them.
RecordingScores units_of(const RecordingScores& scores, Trust& trust) {
  if (!trust.kind_test.possible || !trust.kind_test.systematic || trust.kinds < kManyKinds) return scores;
  RecordingScores merged = merged_by_kind(scores);
  if (RecordingCovariances(merged.g, merged.h).leverages().maxCoeff() > kLargestLeverage) return scores;
  trust.between_kinds = true;
  return merged;
}

// The interval of new kinds by what is known between kinds.
void widen(const Interval& between, Interval& interval) {
  if (between.refused != NoInterval::None) return;
  interval.deviation = between.deviation;
  interval.df = between.df;
  interval.half_width = between.half_width;
}

std::string kind_sentence(const Trust& trust) {
  if (!trust.kind_test.possible || !trust.kind_test.systematic) return "";
  if (trust.between_kinds)
    return fmt::format(
        "Errors repeat within each kind of drive (F = {:.3g}, p = {:.1g}): intervals for new kinds are taken "
        "between kinds.",
        trust.kind_test.f, trust.kind_test.p);
  return fmt::format(
      "Errors repeat within each kind of drive (F = {:.3g}, p = {:.1g}): what stands for the same drives "
      "says how "
      "well the result repeats, not how near it is to the truth{}.",
      trust.kind_test.f, trust.kind_test.p,
      trust.kinds < kManyKinds ? "; more kinds of drive would tell" : "");
}

void add_sentences(const Interval& general, double cost, Trust& trust) {
  std::vector<std::string>& all = trust.sentences;
  if (general.refused != NoInterval::None) {
    all.push_back("No intervals: " + general.reason + ".");
    return;
  }
  std::vector<std::string> told;
  for (const DeterminedNumber& d : trust.determined)
    if (d.interval.refused == NoInterval::None) told.push_back(words_with(d.number, d.interval.half_width));
  if (!told.empty()) all.push_back(fmt::format("The drives determine: {}.", fmt::join(told, ", ")));
  if (!trust.active.empty())
    all.push_back(
        fmt::format("{} of {} parameters lie on their bounds ({}): the result is the best in the box, and no "
                    "single parameter "
                    "is a measurement.",
                    trust.active.size(), trust.parameters.size(), fmt::join(trust.active, ", ")));
  std::vector<std::string> wide;
  for (const ParameterInterval& p : trust.parameters)
    if (p.interval.refused == NoInterval::WiderThanBox) wide.push_back(p.name);
  if (!wide.empty())
    all.push_back(fmt::format("{}: decided by {} bounds, not by the drives.", fmt::join(wide, ", "),
                              wide.size() == 1 ? "its" : "their"));
  if (const std::string kinds = kind_sentence(trust); !kinds.empty()) all.push_back(kinds);
  if (!trust.moved_by_rule.empty()) {
    std::vector<std::string> shifts;
    for (const RuleShift& r : trust.moved_by_rule)
      shifts.push_back(fmt::format("{} by {:.2g} of its +-", r.words, std::abs(r.shift) / r.half_width));
    all.push_back(
        fmt::format("Euler's rule of integration moves all recordings alike, which no interval holds: {}; by "
                    "arcs J would "
                    "be {:.3g} % lower (--integration=arc).",
                    fmt::join(shifts, ", "), 100 * (1 - trust.cost_by_arcs / cost)));
  }
  if (trust.kinds == trust.recordings)
    all.emplace_back("No drive was repeated: the intervals cannot separate noise from errors of the model.");
  all.emplace_back(kWhatIntervalsHold);
}

}  // namespace

Trust assess_trust(const RecordingCosts& costs, const Robot& robot, const ConstVectorRef& z,
                   const TrustOptions& options) {
  if (z.size() != static_cast<Index>(costs.parameters().size()))
    throw std::invalid_argument(
        fmt::format("trust: {} parameters, expected {}", z.size(), costs.parameters().size()));
  Trust trust;
  const Setting s = prepare(costs, z, trust);
  TwistMap map = twist_map(robot, costs.parameters(), z);
  trust.map_linear = map.linear;
  trust.map_remarks = std::move(map.remarks);
  if (s.scores.parameters.empty()) return trust;
  const Interval general = general_refusal(s.scores);
  const RecordingCovariances covariances(s.scores.g, s.scores.h);
  trust.leverages = covariances.leverages();
  RecordingScores units = s.scores;
  trust.ratios_only = costs[0].options().position_weight == 0;
  for (TwistNumber& number : map.numbers)
    if (!trust.ratios_only || number.entry == TwistEntry::Turn || number.entry == TwistEntry::Swing)
      trust.determined.push_back({std::move(number), general});
  if (general.refused == NoInterval::None) {
    trust.kind_test = kind_test(s.scores.g, s.scores.h, s.scores.kinds);
    units = units_of(s.scores, trust);
    if (trust.free == 0) {
      for (DeterminedNumber& d : trust.determined) d.interval = decided_by_the_box();
    } else {
      Matrix exact;
      if (options.exact_hessian)
        exact = exact_half_hessian([&](const Vector& at) { return half_gradient(costs, at); }, s.free, z);
      const LeaveOneOut moves(s.free, exact);
      std::optional<LeaveOneOut> between;
      if (trust.between_kinds) between.emplace(restricted(units, s.free_places), exact);
      trust.exact_hessian = moves.uses_exact();
      trust.hessian_eigenvalues = moves.eigenvalues();
      for (DeterminedNumber& d : trust.determined) {
        const Vector c = s.by_free(d.number.gradient);
        d.interval = c.isZero(0) ? decided_by_the_box() : moves.interval(c);
        if (between && d.interval.refused == NoInterval::None) widen(between->interval(c), d.interval);
      }
      add_basic_drives(s, moves, trust);
      if (options.drives) add_kinds(s, moves, trust);
      if (trust.ratios_only) std::erase_if(trust.drives, [](const DriveError& d) { return d.unit == "m"; });
      if (options.rule) add_rule_shifts(s, robot, exact, trust);
    }
  }
  trust.parameters = parameter_intervals(
      s, units, trust.between_kinds ? RecordingCovariances(units.g, units.h) : covariances, trust.active);
  add_sentences(general, s.scores.cost(), trust);
  return trust;
}

}  // namespace odobench
