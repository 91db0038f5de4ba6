#include "problems/trust/recording_scores.hpp"

#include <algorithm>

#include "problems/information/combinations.hpp"

namespace odobench {

using Eigen::Index;

Matrix RecordingScores::information() const {
  const auto n = static_cast<Index>(parameters.size());
  Matrix sum = Matrix::Zero(n, n);
  for (const Matrix& one : h) sum += one;
  return sum;
}

RecordingScores recording_scores(const RecordingCosts& costs, const ConstVectorRef& z) {
  RecordingScores scores;
  const std::vector<ParameterInfo>& parameters = costs.parameters();
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (parameters[i].lower < parameters[i].upper) scores.parameters.push_back(static_cast<Index>(i));
  scores.scale = relative_scales(parameters)(scores.parameters);
  scores.costs = Vector::Zero(static_cast<Index>(costs.size()));
  NormalEquations e;
  for (std::size_t n = 0; n < costs.size(); ++n) {
    costs[n].normal_equations(z, e);
    scores.recordings.push_back(costs.recording(n).id);
    scores.kinds.push_back(costs.recording(n).trajectory);
    scores.costs[static_cast<Index>(n)] = e.cost;
    scores.g.push_back(scores.scale.cwiseProduct(Vector(e.jtr(scores.parameters))));
    scores.h.push_back(scores.scale.asDiagonal() * Matrix(e.jtj(scores.parameters, scores.parameters)) *
                       scores.scale.asDiagonal());
    scores.residuals += costs[n].residual_count();
    scores.rounding_floor += costs[n].rounding_floor(z);
  }
  return scores;
}

RecordingScores restricted(const RecordingScores& scores, const std::vector<Index>& places) {
  RecordingScores fewer = scores;
  fewer.parameters.clear();
  for (const Index at : places) fewer.parameters.push_back(scores.parameters[static_cast<std::size_t>(at)]);
  fewer.scale = scores.scale(places);
  for (std::size_t n = 0; n < scores.size(); ++n) {
    fewer.g[n] = scores.g[n](places);
    fewer.h[n] = scores.h[n](places, places);
  }
  return fewer;
}

RecordingScores merged_by_kind(const RecordingScores& scores) {
  const KindsOfDrives kinds = kinds_of(scores.kinds);
  RecordingScores merged = scores;
  merged.recordings = merged.kinds = kinds.names;
  merged.g.assign(kinds.names.size(), Vector::Zero(scores.scale.size()));
  merged.h.assign(kinds.names.size(), Matrix::Zero(scores.scale.size(), scores.scale.size()));
  merged.costs = Vector::Zero(static_cast<Index>(kinds.names.size()));
  for (std::size_t n = 0; n < scores.size(); ++n) {
    merged.g[kinds.of[n]] += scores.g[n];
    merged.h[kinds.of[n]] += scores.h[n];
    merged.costs[static_cast<Index>(kinds.of[n])] += scores.costs[static_cast<Index>(n)];
  }
  return merged;
}

bool on_bound(const ParameterInfo& parameter, double value) {
  constexpr double kAtBound = 1e-6;  // of the width of a box
  const double near = kAtBound * (parameter.upper - parameter.lower);
  return parameter.lower < parameter.upper &&
         (value <= parameter.lower + near || value >= parameter.upper - near);
}

Vector half_gradient(const RecordingCosts& costs, const Vector& z) {
  Vector sum = Vector::Zero(z.size());
  NormalEquations e;
  for (std::size_t n = 0; n < costs.size(); ++n) {
    costs[n].normal_equations(z, e);
    sum += e.jtr;
  }
  return sum;
}

KindsOfDrives kinds_of(const std::vector<std::string>& kinds) {
  KindsOfDrives all;
  for (const std::string& kind : kinds) {
    const auto at =
        static_cast<std::size_t>(std::find(all.names.begin(), all.names.end(), kind) - all.names.begin());
    if (at == all.names.size()) {
      all.names.push_back(kind);
      all.counts.push_back(0);
    }
    all.of.push_back(at);
    ++all.counts[at];
  }
  return all;
}

}  // namespace odobench
