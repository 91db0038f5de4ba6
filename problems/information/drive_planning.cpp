#include "problems/information/drive_planning.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/range.hpp"
#include "problems/information/combinations.hpp"

namespace odobench {
namespace {

// Eigenvalues of J'J below this share of the largest are what rounding leaves of zero.
constexpr double kRounding = 1e-15;

struct Totals {
  Matrix normal, scatter;
};

Totals totals(std::span<const DriveInformation> drives, const std::vector<int>& counts, Eigen::Index n,
              const DriveInformation& fixed = {}) {
  if (drives.size() != counts.size())
    throw std::invalid_argument(
        fmt::format("planning: {} drives and {} counts, expected as many", drives.size(), counts.size()));
  Totals t{Matrix::Zero(n, n), Matrix::Zero(n, n)};
  Vector bias = Vector::Zero(n);
  if (fixed.normal.size() > 0) {
    t.normal += fixed.normal;
    t.scatter += fixed.scatter;
    bias += fixed.bias;
  }
  for (std::size_t d = 0; d < drives.size(); ++d) {
    t.normal += counts[d] * drives[d].normal;
    t.scatter += counts[d] * drives[d].scatter;
    bias += counts[d] * drives[d].bias;
  }
  t.scatter += bias * bias.transpose();
  return t;
}

// H and g of one recording in relative parameters, of those that are free.
class RobotEquations {
 public:
  RobotEquations(const Robot& robot, const CalibrationOptions& options, InstructionSet kernel)
      : robot_(robot), options_(options), kernel_(kernel), scale_(relative_scales(free_parameters(robot))) {
    for (std::size_t i = 0; i < robot.parameters.size(); ++i)
      if (robot.parameters[i].lower < robot.parameters[i].upper)
        free_.push_back(static_cast<Eigen::Index>(i));
  }
  Eigen::Index count() const { return scale_.size(); }
  Eigen::Index residuals() const { return residuals_; }
  double cost() const { return cost_; }
  // Counts residuals and cost, too.
  void at(const Recording& recording, const Vector& z, Matrix& normal, Vector& score) {
    const CalibrationProblem problem(robot_, {recording}, options_, kernel_);
    NormalEquations e;
    problem.normal_equations(z, e);
    residuals_ += problem.residual_count();
    cost_ += problem.cost(z);
    normal.resize(count(), count());
    score.resize(count());
    for (Eigen::Index i = 0; i < count(); ++i) {
      const auto row = free_[static_cast<std::size_t>(i)];
      score[i] = scale_[i] * e.jtr[row];
      for (Eigen::Index k = 0; k < count(); ++k)
        normal(i, k) = scale_[i] * e.jtj(row, free_[static_cast<std::size_t>(k)]) * scale_[k];
    }
  }

 private:
  const Robot& robot_;
  const CalibrationOptions& options_;
  InstructionSet kernel_;
  Vector scale_;
  std::vector<Eigen::Index> free_;
  Eigen::Index residuals_ = 0;
  double cost_ = 0;
};

void require_replicas(const std::string& name, std::size_t replicas) {
  if (replicas < 2)
    throw std::invalid_argument(
        fmt::format("planning: drive '{}' has {} replicas, expected at least 2", name, replicas));
}

}  // namespace

std::vector<ParameterInfo> free_parameters(const Robot& robot) {
  std::vector<ParameterInfo> list;
  for (const RobotParameter& p : robot.parameters)
    if (p.lower < p.upper) list.push_back({p.name, p.unit, p.nominal, p.lower, p.upper});
  return list;
}

DriveInformation drive_information(const std::string& name, const Robot& robot,
                                   const CalibrationOptions& options, const std::vector<Recording>& replicas,
                                   const Vector& truth, InstructionSet kernel) {
  require_replicas(name, replicas.size());
  RobotEquations equations(robot, options, kernel);
  const Eigen::Index n = equations.count();
  const auto count = static_cast<double>(replicas.size());
  DriveInformation d{name, Matrix::Zero(n, n), Vector::Zero(n), Matrix::Zero(n, n)};
  Matrix scores(n, static_cast<Eigen::Index>(replicas.size())), normal;
  Vector score;
  for (std::size_t k = 0; k < replicas.size(); ++k) {
    equations.at(replicas[k], truth, normal, score);
    d.normal += normal / count;
    scores.col(static_cast<Eigen::Index>(k)) = score;
  }
  d.bias = scores.rowwise().mean();
  const Matrix deviations = scores.colwise() - d.bias;
  d.scatter = deviations * deviations.transpose() / (count - 1);
  return d;
}

RecordedInformation recorded_information(const std::vector<std::string>& names, const Robot& robot,
                                         const CalibrationOptions& options,
                                         const std::vector<Recording>& recordings, const Vector& fit,
                                         InstructionSet kernel) {
  RobotEquations equations(robot, options, kernel);
  const Eigen::Index n = equations.count();
  RecordedInformation all;
  std::vector<double> counts(names.size(), 0.0);
  for (const std::string& name : names)
    all.drives.push_back({name, Matrix::Zero(n, n), Vector::Zero(n), Matrix::Zero(n, n)});
  Matrix normal;
  Vector score;
  for (const Recording& r : recordings) {
    const auto i =
        static_cast<std::size_t>(std::find(names.begin(), names.end(), r.trajectory) - names.begin());
    if (i == names.size())
      throw std::invalid_argument(fmt::format("planning: recording '{}' is of no trajectory", r.id));
    equations.at(r, fit, normal, score);
    all.drives[i].normal += normal;
    all.drives[i].scatter += score * score.transpose();
    ++counts[i];
  }
  const auto total = static_cast<double>(recordings.size());
  all.by_recording = total >= static_cast<double>(n) + 2;
  const double left = static_cast<double>(equations.residuals() - n);
  const double variance = equations.cost() / std::max(left, 1.0);
  for (std::size_t i = 0; i < names.size(); ++i) {
    DriveInformation& d = all.drives[i];
    if (counts[i] > 0) d.normal /= counts[i];
    if (all.by_recording && counts[i] > 0) d.scatter *= total / (total - 1) / counts[i];
    if (!all.by_recording) d.scatter = variance * d.normal;
  }
  return all;
}

DriveInformation drive_information(const std::string& name, const std::vector<ParameterInfo>& parameters,
                                   const std::vector<Recording>& replicas, const Vector& truth,
                                   InstructionSet kernel) {
  require_replicas(name, replicas.size());
  const Vector scale = relative_scales(parameters);
  const Eigen::Index n = scale.size();
  DriveInformation d{name, Matrix::Zero(n, n), Vector::Zero(n), Matrix::Zero(n, n)};
  const auto count = static_cast<double>(replicas.size());
  Matrix scores(n, static_cast<Eigen::Index>(replicas.size()));
  for (std::size_t k = 0; k < replicas.size(); ++k) {
    NormalEquations e;
    CalibrationProblem(parameters, {replicas[k]}, kernel).normal_equations(truth, e);
    d.normal += scale.asDiagonal() * e.jtj * scale.asDiagonal() / count;
    scores.col(static_cast<Eigen::Index>(k)) = scale.cwiseProduct(e.jtr);
  }
  d.bias = scores.rowwise().mean();
  const Matrix deviations = scores.colwise() - d.bias;
  d.scatter = deviations * deviations.transpose() / (count - 1);
  return d;
}

DriveInformation ideal_information(const std::string& name, const std::vector<ParameterInfo>& parameters,
                                   const Recording& recording, const Vector& truth, double sigma,
                                   InstructionSet kernel) {
  const Vector scale = relative_scales(parameters);
  NormalEquations e;
  CalibrationProblem(parameters, {recording}, kernel).normal_equations(truth, e);
  const Matrix normal = scale.asDiagonal() * e.jtj * scale.asDiagonal();
  return {name, normal, Vector::Zero(scale.size()), sigma * sigma * normal};
}

PlanAnalysis analyse_drives(std::span<const DriveInformation> drives, const std::vector<int>& counts,
                            const std::vector<ParameterInfo>& parameters, double wanted) {
  const auto n = static_cast<Eigen::Index>(parameters.size());
  const Totals t = totals(drives, counts, n);
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(t.normal);
  const double cut = kRounding * static_cast<double>(n) * std::max(eigen.eigenvalues()[n - 1], 0.0);
  Eigen::Index invisible = 0;
  while (invisible < n && eigen.eigenvalues()[invisible] <= cut) ++invisible;
  const Matrix dark = eigen.eigenvectors().leftCols(invisible);
  const Matrix seen = eigen.eigenvectors().rightCols(n - invisible);

  // Covariance in the basis of what the drives show; what they do not has none.
  const Vector inverse = eigen.eigenvalues().tail(n - invisible).cwiseInverse();
  const Matrix inner = inverse.asDiagonal() * (seen.transpose() * t.scatter * seen) * inverse.asDiagonal();
  const Matrix covariance = seen * inner * seen.transpose();
  PlanAnalysis a;
  a.standard_deviations = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  for (Eigen::Index i = 0; i < n; ++i)
    if (dark.row(i).norm() > 1e-6) a.standard_deviations[i] = kInfinity;

  Matrix undetermined(n, n);
  Eigen::Index count = 0;
  if (n > invisible) {
    const Eigen::SelfAdjointEigenSolver<Matrix> principal(inner);
    for (Eigen::Index k = 0; k < n - invisible; ++k) {
      const double sd = std::sqrt(std::max(principal.eigenvalues()[k], 0.0));
      a.directions.push_back({sd > 0 ? 1 / sd : kInfinity, sd, seen * principal.eigenvectors().col(k)});
      if (sd > wanted) undetermined.col(count++) = a.directions.back().vector;
    }
  }
  for (Eigen::Index k = invisible; k-- > 0;) {
    a.directions.push_back({0, kInfinity, dark.col(k)});
    undetermined.col(count++) = dark.col(k);
  }
  a.undetermined = sparse_basis(undetermined.leftCols(count));
  for (Eigen::Index k = 0; k < count; ++k)
    a.undetermined_words.push_back(combination_words(a.undetermined.col(k), parameters));
  return a;
}

std::vector<Proposal> propose_drives(std::span<const DriveInformation> drives, std::vector<int> counts,
                                     const DriveInformation& fixed,
                                     const std::vector<ParameterInfo>& parameters, double wanted, int most) {
  const auto n = static_cast<Eigen::Index>(parameters.size());
  const Vector scale = relative_scales(parameters);
  Matrix all = Matrix::Zero(n, n), noise = Matrix::Zero(n, n);
  for (const DriveInformation& d : drives) {
    all += d.normal;
    noise += d.scatter + d.bias * d.bias.transpose();
  }
  // The box as a measurement with the noise that the drives have on average.
  const double variance = std::max(noise.trace() / all.trace(), 1e-300);
  Vector ridge(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const ParameterInfo& p = parameters[static_cast<std::size_t>(i)];
    const double half = std::max((p.upper - p.lower) / 2 / scale[i], 1e-9);
    ridge[i] = variance / (half * half);
  }
  const auto deviations = [&](const std::vector<int>& c) {
    const Totals t = totals(drives, c, n, fixed);
    const Matrix normal = t.normal + Matrix(ridge.asDiagonal());
    const Matrix scatter = t.scatter + Matrix((variance * ridge).asDiagonal());
    const Eigen::LDLT<Matrix> factor(normal);
    const Matrix half = factor.solve(scatter);
    return Vector(factor.solve(Matrix(half.transpose())).diagonal().cwiseMax(0.0).cwiseSqrt());
  };
  const auto excess = [&](const Vector& sd) { return (sd.array() / wanted).log().max(0.0).sum(); };

  std::vector<Proposal> list;
  Vector now = deviations(counts);
  while (now.maxCoeff() > wanted && static_cast<int>(list.size()) < most) {
    std::size_t best = 0;
    double lowest = kInfinity;
    for (std::size_t d = 0; d < drives.size(); ++d) {
      ++counts[d];
      const double value = excess(deviations(counts));
      --counts[d];
      if (value < lowest) {
        lowest = value;
        best = d;
      }
    }
    ++counts[best];
    now = deviations(counts);
    list.push_back({best, now.maxCoeff()});
  }
  return list;
}

}  // namespace odobench
