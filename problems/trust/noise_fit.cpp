#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <utility>

#include "problems/trust/noise_material.hpp"
#include "problems/trust/noise_scoring.hpp"
#include "problems/trust/odometry_noise.hpp"

namespace odobench {
namespace {

using noise::Material;
using noise::Segment;

constexpr double kLeastRatio = 0.05;  // m/rad, rad/m: below, nothing is said about the rarer one
constexpr double kOneRatio = 0.995;   // cosine of metres and radians: above, they are one thing
constexpr std::size_t kMostGroups = 60, kFewestGroups = 10, kMostFolds = 10;
constexpr std::size_t kMostWork = 72000;           // segments times groups
constexpr std::size_t kFewestForCovariances = 50;  // segments

using Reasons = std::array<std::string, kNoiseTerms>;

void say(Reasons& reasons, std::initializer_list<int> terms, const std::string& why) {
  for (const int t : terms)
    if (reasons[static_cast<std::size_t>(t)].empty()) reasons[static_cast<std::size_t>(t)] = why;
}

// What the drives do not tell, and why.
Reasons untold(const Material& m, const NoiseFit& fit, const std::vector<Segment>& used) {
  Reasons reasons;
  double mm = 0, rr = 0, mr = 0;
  for (const Segment& s : used) {
    mm += s.metres * s.metres;
    rr += s.radians * s.radians;
    mr += s.metres * s.radians;
  }
  if (fit.radians < kLeastRatio * fit.metres)
    say(reasons, {kForward, kSideways, kTurn, kForwardTurn, kSidewaysTurn},
        fmt::format("the drives turn by {:.2g} rad in {:.2g} m only", fit.radians, fit.metres));
  else if (fit.metres < kLeastRatio * fit.radians)
    say(reasons, {kAlong, kAcross, kHeading, kAlongHeading, kAcrossHeading},
        fmt::format("the drives travel {:.2g} m in {:.2g} rad only", fit.metres, fit.radians));
  else if (mr > kOneRatio * std::sqrt(mm * rr))
    say(reasons, {kForward, kSideways, kTurn, kForwardTurn, kSidewaysTurn},
        "the drives travel and turn in one proportion: all of it is counted per metre");
  if (m.levels < 2)
    say(reasons, {kCapturePosition, kCaptureHeading, kCaptureStamp},
        "the reference has too few places on the way: its noise counts as the odometry's");
  if (used.size() < kFewestForCovariances)
    say(reasons, {kAlongHeading, kAcrossHeading, kForwardTurn, kSidewaysTurn},
        fmt::format("{} parts of drives, expected {}", used.size(), kFewestForCovariances));
  return reasons;
}

// Models without a group of drives each.
std::vector<NoiseModel> delete_groups(const Material& m, const std::vector<std::size_t>& used,
                                      std::size_t segments, bool separated,
                                      const std::array<bool, kNoiseTerms>& wanted, const NoiseModel& all) {
  const std::size_t groups = std::min(
      used.size(), std::clamp(kMostWork / std::max<std::size_t>(segments, 1), kFewestGroups, kMostGroups));
  std::vector<NoiseModel> models;
  for (std::size_t g = 0; g < groups; ++g) {
    std::vector<bool> keep(m.parts.size(), true);
    for (std::size_t k = g; k < used.size(); k += groups) keep[used[k]] = false;
    models.push_back(noise::score(noise::material_of(m, keep, separated), wanted, &all).model);
  }
  return models;
}

double jackknife_variance(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  double mean = 0, sum = 0;
  for (const double v : values) mean += v / n;
  for (const double v : values) sum += (v - mean) * (v - mean);
  return (n - 1) / n * sum;
}

// A variance that is 0 with and without any drive has no spread, which is no precision: the curvature of its
// own bounds it then, the levels counted as one.
void set_intervals(const std::vector<NoiseModel>& without, const noise::Scored& scored, int levels,
                   double freedom, NoiseFit& fit) {
  const double t = boost::math::quantile(boost::math::students_t(std::max(1.0, freedom)), 0.975);
  for (std::size_t m = 0; m < fit.terms.size(); ++m) {
    std::vector<double> values;
    for (const NoiseModel& one : without) values.push_back(one.value[m]);
    NoiseEstimate& e = fit.terms[m];
    if (!e.undetermined.empty()) continue;
    double deviation = std::sqrt(jackknife_variance(values));
    if (e.value == 0 && m < kNoiseVariances)
      deviation = std::max(deviation, std::sqrt(static_cast<double>(levels)) * scored.deviation[m]);
    if (m >= kNoiseVariances) {
      e.lower = e.value - t * deviation;
      e.upper = e.value + t * deviation;
    } else if (e.value > 0 && deviation < e.value) {
      e.lower = e.value * std::exp(-t * deviation / e.value);
      e.upper = e.value * std::exp(t * deviation / e.value);
    } else {
      e.lower = 0;
      e.upper = e.value + t * deviation;
    }
  }
}

double nees_of(const NoiseModel& model, const Segment& segment, const Eigen::Vector3d& error) {
  Eigen::Matrix3d p = noise::covariance_of(model, segment);
  p.diagonal().array() += 1e-20;
  return error.dot(p.ldlt().solve(error));
}

Eigen::Vector3d mean_error(const Material& m, const std::vector<std::size_t>& drives) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const std::size_t n : drives) mean += m.whole[n].error / static_cast<double>(drives.size());
  return mean;
}

void describe_kinds(const Material& m, NoiseFit& fit) {
  for (std::size_t kind = 0; kind < m.kinds.size(); ++kind) {
    const std::vector<std::size_t>& members = m.members[kind];
    if (members.empty()) continue;
    NoiseKind out;
    out.trajectory = m.kinds[kind];
    out.drives = static_cast<int>(members.size());
    out.repeated = m.repeated[kind];
    out.nees = std::numeric_limits<double>::quiet_NaN();
    const auto count = static_cast<double>(members.size());
    if (out.repeated) out.bias = mean_error(m, members);
    for (const std::size_t n : members) {
      out.scatter += (m.whole[n].error - out.bias).cwiseAbs2() / (out.repeated ? count - 1 : count);
      out.predicted += noise::covariance_of(fit.model, m.whole[n]).diagonal() / count;
    }
    out.scatter = out.scatter.cwiseSqrt();
    out.predicted = out.predicted.cwiseMax(0).cwiseSqrt();
    fit.kinds.push_back(out);
  }
}

// e - mean of the others has the covariance of a single error times count/(count - 1), and so do all of a
// kind together lose a degree of freedom: sum (count - 1)/count NEES is chi-square of 3 (count - 1).
struct LeftOut {
  double sum = 0, freedom = 0;
  int drives = 0;
  void add(double nees, double count) {
    const double share = count > 1 ? (count - 1) / count : 1;
    sum += share * nees;
    freedom += 3 * share;
    ++drives;
  }
};

// NEES of a drive against the bias of the others of its kind.
double left_out_nees(const Material& m, const NoiseModel& model, std::size_t n, bool separated) {
  const std::vector<std::size_t>& members = m.members[m.kind_of[n]];
  if (!separated) return nees_of(model, m.whole[n], m.whole[n].error);
  const auto count = static_cast<double>(members.size());
  const Eigen::Vector3d deviation = m.whole[n].error - mean_error(m, members);
  return nees_of(model, m.whole[n], deviation) * count / (count - 1);
}

void check_left_out(const Material& m, const std::vector<std::size_t>& used,
                    const std::array<bool, kNoiseTerms>& wanted, const std::vector<NoiseModel>& without,
                    NoiseFit& fit) {
  std::vector<std::size_t> fold(m.parts.size(), 0), taken(m.kinds.size(), 0);
  std::size_t folds = 0;
  for (const std::size_t n : used) folds = std::max(folds, m.members[m.kind_of[n]].size());
  folds = std::clamp<std::size_t>(folds, fit.separated ? 2 : 5, kMostFolds);
  for (std::size_t k = 0; k < used.size(); ++k)
    fold[used[k]] = (fit.separated ? taken[m.kind_of[used[k]]]++ : k) % folds;
  LeftOut all;
  std::vector<LeftOut> of_kind(m.kinds.size());
  for (std::size_t f = 0; f < folds; ++f) {
    std::vector<bool> keep(m.parts.size(), true);
    for (const std::size_t n : used) keep[n] = fold[n] != f;
    const std::vector<Segment> rest = noise::material_of(m, keep, fit.separated);
    if (rest.empty()) continue;
    const NoiseModel model = noise::score(rest, wanted, &fit.model).model;
    for (const std::size_t n : used) {
      if (fold[n] != f) continue;
      const double count = fit.separated ? static_cast<double>(m.members[m.kind_of[n]].size()) : 1;
      const double nees = left_out_nees(m, model, n, fit.separated);
      all.add(nees, count);
      of_kind[m.kind_of[n]].add(nees, count);
    }
  }
  if (all.drives == 0) return;
  // How sure the predicted size is: the same sum with the models of the jackknife.
  std::vector<double> sums;
  for (const NoiseModel& model : without) {
    LeftOut own;
    for (const std::size_t n : used)
      own.add(left_out_nees(m, model, n, fit.separated),
              fit.separated ? static_cast<double>(m.members[m.kind_of[n]].size()) : 1);
    sums.push_back(std::log(std::max(own.sum, 1e-300)));
  }
  const double spread =
      jackknife_variance(sums) * static_cast<double>(folds) / static_cast<double>(folds - 1);
  const double second = std::clamp(2 / std::max(spread, 1e-9), 4.0, 1e6);
  const boost::math::fisher_f band(all.freedom, second);
  fit.checked = all.drives;
  fit.nees = 3 * all.sum / all.freedom;
  fit.nees_lower = 3 * boost::math::quantile(band, 0.025);
  fit.nees_upper = 3 * boost::math::quantile(band, 0.975);
  for (NoiseKind& kind : fit.kinds)
    for (std::size_t k = 0; k < m.kinds.size(); ++k)
      if (m.kinds[k] == kind.trajectory && of_kind[k].drives > 0)
        kind.nees = 3 * of_kind[k].sum / of_kind[k].freedom;
}

void compare_lengths(const std::vector<Segment>& used, int levels, NoiseFit& fit) {
  for (int level = 0; level < levels; ++level) {
    NoiseLength length;
    double weight = 0;
    for (const Segment& s : used) {
      if (s.level != level) continue;
      ++length.segments;
      length.metres += s.weight * s.metres;
      length.radians += s.weight * s.radians;
      length.ratio += s.weight * nees_of(fit.model, s, s.error) / 3;
      weight += s.weight;
    }
    if (length.segments == 0) continue;
    length.metres /= weight;
    length.radians /= weight;
    length.ratio /= weight;
    fit.lengths.push_back(length);
  }
}

// Drives that take part, and whether there are enough: "" or why not.
std::string choose(const Material& m, bool with_bias, NoiseFit& fit, std::vector<std::size_t>& used,
                   double& freedom) {
  int apart = 0, movers = 0;
  for (std::size_t kind = 0; kind < m.kinds.size(); ++kind) {
    movers += static_cast<int>(m.members[kind].size());
    if (m.repeated[kind]) apart += static_cast<int>(m.members[kind].size()) - 1;
  }
  if (movers < kFewestDrives)
    return fmt::format("{} drive{} with a reference at two places of a path, expected at least {}", movers,
                       movers == 1 ? "" : "s", kFewestDrives);
  fit.separated = apart >= kFewestFree && !with_bias;
  for (std::size_t n = 0; n < m.parts.size(); ++n)
    if (!m.parts[n].empty() && (!fit.separated || m.repeated[m.kind_of[n]])) used.push_back(n);
  freedom = fit.separated ? apart : static_cast<double>(used.size());
  fit.drives = static_cast<int>(used.size());
  for (const std::size_t n : used) {
    fit.metres += m.paths[n].metres;
    fit.radians += m.paths[n].radians;
  }
  if (fit.metres + fit.radians < 1)
    return fmt::format("the drives make {:.2g} m and {:.2g} rad altogether, expected at least 1", fit.metres,
                       fit.radians);
  return "";
}

}  // namespace

NoiseFit fit_odometry_noise(const std::vector<NoiseDrive>& drives, const NoiseOptions& options) {
  NoiseFit fit;
  const Material m = noise::prepare(drives);
  std::vector<std::size_t> used;
  double freedom = 0;
  fit.refused = choose(m, options.with_bias, fit, used, freedom);
  if (!fit.refused.empty()) return fit;
  const std::vector<Segment> segments =
      noise::material_of(m, std::vector<bool>(drives.size(), true), fit.separated);
  const Reasons reasons = untold(m, fit, segments);
  std::array<bool, kNoiseTerms> wanted{};
  for (std::size_t t = 0; t < wanted.size(); ++t) wanted[t] = reasons[t].empty();
  const noise::Scored scored = noise::score(segments, wanted);
  fit.model = scored.model;
  fit.held_back = scored.held_back + m.lost;
  fit.segments = static_cast<int>(segments.size());
  for (std::size_t t = 0; t < wanted.size(); ++t) {
    const double v = fit.model.value[t];
    fit.terms[t] = {v, v, v, reasons[t]};
  }
  fit.typical = noise::typical_motion(drives, m.paths);
  describe_kinds(m, fit);
  compare_lengths(segments, m.levels, fit);
  if (!options.intervals && !options.check) return fit;
  const std::vector<NoiseModel> without =
      delete_groups(m, used, segments.size(), fit.separated, wanted, fit.model);
  if (options.intervals) set_intervals(without, scored, m.levels, freedom, fit);
  if (options.check) check_left_out(m, used, wanted, without, fit);
  return fit;
}

}  // namespace odobench
