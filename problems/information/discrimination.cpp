#include "problems/information/discrimination.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace odobench {
namespace {

constexpr std::size_t kMostStamps = 400;

double quadratic(const Eigen::Vector3d& d, const Eigen::Matrix3d& covariance) {
  // Metres and radians of one drive are of one magnitude: no scaling is needed.
  return std::max(0.0, d.dot(covariance.ldlt().solve(d)));
}

double effective_count(const std::vector<double>& errors) {
  const std::size_t n = errors.size();
  double zero = 0;
  for (const double e : errors) zero += e * e;
  if (n < 2 || !(zero > 0)) return 0;
  double sum = 0;
  for (std::size_t lag = 1; lag < n; ++lag) {
    double product = 0;
    for (std::size_t k = lag; k < n; ++k) product += errors[k] * errors[k - lag];
    if (product <= 0) break;
    sum += product / zero;
  }
  return static_cast<double>(n) / (1 + 2 * sum);
}

}  // namespace

double Discrimination::separation(double n) const {
  return std::sqrt(quadratic(difference, scatter / n + open_a + open_b));
}

double probability_right(double separation) {
  return 0.5 * std::erfc(-separation / (2 * std::sqrt(2.0)));
}

std::optional<int> Discrimination::repetitions(double wanted, int most) const {
  for (int n = 1; n <= most; ++n)
    if (probability_right(separation(n)) >= wanted) return n;
  return std::nullopt;
}

Discrimination discriminate(const EndPrediction& a, const EndPrediction& b, const Eigen::Matrix3d& scatter) {
  return {a.end - b.end, scatter, a.open, b.open};
}

double effective_residuals(const CalibrationProblem& problem, const ConstVectorRef& z) {
  double sum = 0;
  for (std::size_t r = 0; r < problem.recordings().size(); ++r) {
    const Reference& reference = problem.recordings()[r].reference;
    const PoseTrack track = problem.integrate(r, z);
    const std::size_t entries = reference.x.size(), used = std::min(entries, kMostStamps);
    std::vector<double> x, y, heading;
    for (std::size_t k = 1; k < used; ++k) {
      const std::size_t entry = k * (entries - 1) / (used - 1);
      const std::size_t stamp = reference.sample.empty() ? entry : reference.sample[entry];
      x.push_back(track.x[stamp] - reference.x[entry]);
      y.push_back(track.y[stamp] - reference.y[entry]);
      heading.push_back(track.theta[stamp] - reference.theta[entry]);
    }
    sum += effective_count(x) + effective_count(y) + effective_count(heading);
  }
  return sum;
}

Matrix fitted_covariance(const RecordingCosts& recordings, const CalibrationProblem& problem,
                         const ConstVectorRef& z) {
  const std::vector<ParameterInfo>& parameters = problem.parameters();
  const double cost = problem.cost(z), count = effective_residuals(problem, z);
  Matrix covariance = Matrix::Zero(z.size(), z.size());
  if (!(cost > 0) || !(count > 0)) return covariance;
  std::vector<Eigen::Index> free;
  Vector sd(z.size());  // of the boxes: the unit of all below
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const ParameterInfo& p = parameters[static_cast<std::size_t>(i)];
    if (!(p.lower < p.upper)) continue;
    free.push_back(i);
    sd[i] = (p.upper - p.lower) / std::sqrt(12.0);
  }
  const auto m = static_cast<Eigen::Index>(free.size());
  const double variance = cost / count, groups = static_cast<double>(recordings.size());
  Matrix normal = variance * Matrix::Identity(m, m);  // R
  std::vector<Matrix> each;
  Matrix scores(m, static_cast<Eigen::Index>(recordings.size()));
  for (const NormalEquations& e : recordings.normal_equations(z)) {
    Matrix one(m, m);
    const auto n = static_cast<Eigen::Index>(each.size());
    for (Eigen::Index i = 0; i < m; ++i) {
      const Eigen::Index row = free[static_cast<std::size_t>(i)];
      scores(i, n) = sd[row] * e.jtr[row];
      for (Eigen::Index k = 0; k < m; ++k) {
        const Eigen::Index column = free[static_cast<std::size_t>(k)];
        one(i, k) = sd[row] * e.jtj(row, column) * sd[column];
      }
    }
    normal += one;
    each.push_back(std::move(one));
  }
  const Vector mean = scores.rowwise().mean();
  const Matrix inverse = normal.llt().solve(Matrix::Identity(m, m));
  Matrix inner = variance * variance * inverse * inverse;
  for (Eigen::Index n = 0; n < scores.cols(); ++n) {
    const Vector move =
        Matrix(normal - each[static_cast<std::size_t>(n)]).ldlt().solve(Vector(scores.col(n) - mean));
    inner += (groups - 1) / groups * move * move.transpose();
  }
  for (Eigen::Index i = 0; i < m; ++i)
    for (Eigen::Index k = 0; k < m; ++k) {
      const Eigen::Index row = free[static_cast<std::size_t>(i)], column = free[static_cast<std::size_t>(k)];
      covariance(row, column) = sd[row] * inner(i, k) * sd[column];
    }
  return covariance;
}

}  // namespace odobench
