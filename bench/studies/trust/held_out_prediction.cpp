#include "bench/studies/trust/held_out_prediction.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "bench/studies/trust/validation.hpp"

namespace odobench {
namespace {
using Eigen::Index;

constexpr double kNearBound = 1e-6;   // of the width of the box, as of records
constexpr double kDifference = 1e-5;  // of the differences, in units of |nominal|

struct FreeParameters {
  std::vector<Index> places;
  Vector scale;  // |nominal|, half the box where that is 0
};

FreeParameters free_parameters(const std::vector<ParameterInfo>& parameters, const Vector& z) {
  FreeParameters free;
  std::vector<double> scale;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const ParameterInfo& p = parameters[i];
    const double near = kNearBound * (p.upper - p.lower), value = z[static_cast<Index>(i)];
    if (p.lower == p.upper || value <= p.lower + near || value >= p.upper - near) continue;
    free.places.push_back(static_cast<Index>(i));
    scale.push_back(p.nominal != 0 ? std::abs(p.nominal) : (p.upper - p.lower) / 2);
  }
  free.scale = Eigen::Map<Vector>(scale.data(), static_cast<Index>(scale.size()));
  return free;
}

Vector part(const Vector& all, const FreeParameters& free) {
  return all(free.places).cwiseProduct(free.scale);
}

Vector score_of_all(const RecordingCosts& recordings, const Vector& z, const FreeParameters& free) {
  Vector sum = Vector::Zero(free.scale.size());
  for (const NormalEquations& one : recordings.normal_equations(z)) sum += part(one.jtr, free);
  return sum;
}

// Half the Hessian of J, symmetric.
Matrix half_hessian(const RecordingCosts& recordings, const Vector& z, const FreeParameters& free) {
  const Index m = free.scale.size();
  Matrix hessian(m, m);
  for (Index j = 0; j < m; ++j) {
    const double step = kDifference * free.scale[j];
    Vector above = z, below = z;
    above[free.places[static_cast<std::size_t>(j)]] += step;
    below[free.places[static_cast<std::size_t>(j)]] -= step;
    hessian.col(j) =
        (score_of_all(recordings, above, free) - score_of_all(recordings, below, free)) / (2 * kDifference);
  }
  return (hessian + hessian.transpose()) / 2;
}

}  // namespace

std::optional<double> predicted_held_out_cost(const RecordingCosts& recordings, const Vector& z) {
  const FreeParameters free = free_parameters(recordings.parameters(), z);
  const std::vector<DrivesOfKind> kinds = kinds_of(drive_names(recordings));
  std::size_t fewest = kinds.front().recordings.size();
  for (const DrivesOfKind& kind : kinds) fewest = std::min(fewest, kind.recordings.size());
  const Index m = free.scale.size();
  if (m == 0 || fewest < 2) return std::nullopt;
  const std::vector<NormalEquations> each = recordings.normal_equations(z);
  double cost = 0;
  Matrix gauss_newton = Matrix::Zero(m, m), between = Matrix::Zero(m, m);
  for (const NormalEquations& one : each) {
    cost += one.cost;
    gauss_newton += free.scale.asDiagonal() * one.jtj(free.places, free.places) * free.scale.asDiagonal();
  }
  for (const DrivesOfKind& kind : kinds) {
    const auto k = static_cast<double>(kind.recordings.size());
    Vector mean = Vector::Zero(m);
    for (const std::size_t n : kind.recordings) mean += part(each[n].jtr, free) / k;
    for (const std::size_t n : kind.recordings) {
      const Vector d = part(each[n].jtr, free) - mean;
      between += k / (k - 1) * d * d.transpose();
    }
  }
  Eigen::LLT<Matrix> factor(half_hessian(recordings, z, free));
  if (factor.info() != Eigen::Success) factor.compute(gauss_newton);
  if (factor.info() != Eigen::Success) return std::nullopt;
  const auto r = static_cast<double>(fewest);
  const double predicted = cost + 2 * r / (r - 1) * factor.solve(between).trace();
  return std::isfinite(predicted) ? std::optional<double>(predicted) : std::nullopt;
}

}  // namespace odobench
