#include "problems/trust/weighted_down.hpp"

#include <algorithm>
#include <cmath>

#include "problems/trust/error_scales.hpp"

namespace odobench {

using Eigen::Index;

namespace {

constexpr std::size_t kNamed = 3, kMostStretches = 5;
constexpr double kOutlier = 6, kLight = 0.1;

// Of every row of a recording, from its squared residuals.
std::vector<double> row_weights(const Loss& loss, const ConstVectorRef& e, Index row) {
  std::vector<double> weights;
  if (loss.scope == LossScope::Recording) {
    const double s =
        e.squaredNorm() / (static_cast<double>(e.size() / row) * loss.position_scale * loss.position_scale);
    weights.assign(static_cast<std::size_t>(e.size() / row), loss.at(s).weight);
    return weights;
  }
  for (Index i = 0; i < e.size(); i += row) {
    double weight =
        loss.at(e.segment<2>(i).squaredNorm() / (loss.position_scale * loss.position_scale)).weight;
    if (row == 3) {
      const double s = e[i + 2] / loss.heading_scale;
      weight = std::min(weight, loss.at(s * s).weight);
    }
    weights.push_back(weight);
  }
  return weights;
}

// Samples of the row before and of row i (of pieces: where they begin and end).
std::size_t sample_of(const CalibrationProblem& problem, std::size_t recording, std::size_t row) {
  return problem.structured() ? row : problem.rows(recording)[row];
}

std::vector<WeightedDown> stretches(const CalibrationProblem& problem, std::size_t n, double ratio,
                                    const std::vector<double>& weights) {
  struct Run {
    std::size_t first, last;
  };
  std::vector<Run> runs;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (!(weights[i] < kLight)) continue;
    if (!runs.empty() && runs.back().last + 1 == i)
      runs.back().last = i;
    else
      runs.push_back({i, i});
  }
  std::stable_sort(runs.begin(), runs.end(),
                   [](const Run& a, const Run& b) { return a.last - a.first > b.last - b.first; });
  if (runs.size() > kMostStretches) runs.resize(kMostStretches);
  std::sort(runs.begin(), runs.end(), [](const Run& a, const Run& b) { return a.first < b.first; });
  const bool pieces = problem.options().cost == CostKind::Segments;
  std::vector<WeightedDown> list;
  for (const Run& run : runs) {
    WeightedDown one{n, ratio, ratio > kOutlier};
    one.first = sample_of(problem, n, run.first + (pieces ? 0 : 1));
    one.last = sample_of(problem, n, run.last + 1);
    for (std::size_t i = run.first; i <= run.last; ++i) one.weight = std::min(one.weight, weights[i]);
    list.push_back(one);
  }
  return list;
}

}  // namespace

std::vector<WeightedDown> weighted_down(const Robot& robot, const CalibrationProblem& problem,
                                        const ConstVectorRef& z) {
  const Loss& loss = problem.options().loss;
  if (!loss.robust()) return {};
  CalibrationOptions plain = problem.options();
  plain.loss = {};
  const CalibrationProblem squared(robot, problem.recordings(), plain, problem.kernel());
  const Index row = plain.cost == CostKind::Optiodom ? 2 : 3;
  Vector r(squared.residual_count());
  squared.residuals(z, r);
  const std::vector<double> deviations = recording_deviations(squared, z);
  const double usual = middle_of(deviations);
  std::vector<WeightedDown> whole, parts;
  Index first = 0;
  for (std::size_t n = 0; n < deviations.size(); ++n) {
    const Index count = squared.residual_count(n);
    const std::vector<double> weights = row_weights(loss, r.segment(first, count), row);
    first += count;
    if (weights.empty()) continue;
    WeightedDown one{n, usual > 0 ? deviations[n] / usual : 0};
    one.outlier = one.ratio > kOutlier;
    double sum = 0;
    for (const double w : weights) sum += w;
    one.weight = sum / static_cast<double>(weights.size());
    whole.push_back(one);
    if (loss.scope == LossScope::Sample)
      for (const WeightedDown& part : stretches(squared, n, one.ratio, weights)) parts.push_back(part);
  }
  std::stable_sort(whole.begin(), whole.end(),
                   [](const WeightedDown& a, const WeightedDown& b) { return a.ratio > b.ratio; });
  std::size_t keep = std::min(kNamed, whole.size());
  while (keep < whole.size() && whole[keep].outlier) ++keep;
  whole.resize(keep);
  whole.insert(whole.end(), parts.begin(), parts.end());
  return whole;
}

}  // namespace odobench
