#include "problems/trust/intervals.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

namespace odobench {

using Eigen::Index;

namespace {

constexpr double kShare = 1e-6;  // of a variance, where one recording decides it
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Interval refusal(NoInterval why, std::string reason) {
  Interval none;
  none.refused = why;
  none.reason = std::move(reason);
  return none;
}

// Where a recording alone decides c: that one.
Interval refused_by_leverage(const RecordingScores& scores, const RecordingCovariances& covariances,
                             const Vector& c) {
  const Vector leverages = covariances.leverages();
  for (Index n = 0; n < leverages.size(); ++n) {
    const auto at = static_cast<std::size_t>(n);
    if (leverages[n] <= kLargestLeverage || covariances.share_of(at, kLargestLeverage, c) <= kShare) continue;
    return refusal(NoInterval::OneRecordingTells,
                   fmt::format("only {} tells: repeat that drive", scores.recordings[at]));
  }
  return {};
}

// Orthonormal columns, orthogonal to the directions in which one recording decides.
Matrix shared_directions(const RecordingCovariances& covariances) {
  const Index k = covariances.basis().cols();
  Matrix alone(k, 0);
  for (const Matrix& h : covariances.informations()) {
    const Eigen::SelfAdjointEigenSolver<Matrix> eigen(h);
    for (Index i = 0; i < k; ++i) {
      if (eigen.eigenvalues()[i] <= kLargestLeverage) continue;
      alone.conservativeResize(k, alone.cols() + 1);
      alone.rightCols(1) = eigen.eigenvectors().col(i);
    }
  }
  if (alone.cols() == 0) return Matrix::Identity(k, k);
  const Eigen::ColPivHouseholderQR<Matrix> qr(alone);
  const Matrix q = qr.householderQ();
  return q.rightCols(k - qr.rank());
}

}  // namespace

Interval::Interval()
    : deviation(kNaN),
      df(kNaN),
      half_width(kNaN),
      same_deviation(kNaN),
      same_df(kNaN),
      same_half_width(kNaN) {}

std::string_view name_of(NoInterval reason) {
  switch (reason) {
    case NoInterval::None:
      break;
    case NoInterval::OneRecording:
      return "one_recording";
    case NoInterval::TooFewRecordings:
      return "too_few_recordings";
    case NoInterval::NoNoise:
      return "no_noise";
    case NoInterval::Undetermined:
      return "undetermined";
    case NoInterval::OneRecordingTells:
      return "one_recording_tells";
    case NoInterval::TooFewDegreesOfFreedom:
      return "too_few_degrees_of_freedom";
    case NoInterval::BoundActive:
      return "bound_active";
    case NoInterval::WiderThanBox:
      return "wider_than_box";
    case NoInterval::NotRepeated:
      return "not_repeated";
  }
  return "none";
}

Interval general_refusal(const RecordingScores& scores) {
  if (scores.size() <= 1)
    return refusal(
        NoInterval::OneRecording,
        "one recording: how far the result can be trusted is unknown; drive each kind at least three "
        "times");
  if (scores.size() < kLeastRecordings)
    return refusal(NoInterval::TooFewRecordings,
                   fmt::format("{} recordings are too few for intervals: {} are needed", scores.size(),
                               kLeastRecordings));
  if (!(scores.cost() > scores.rounding_floor))
    return refusal(NoInterval::NoNoise, "the data carry no noise: nothing to take intervals from");
  return {};
}

Matrix exact_half_hessian(const std::function<Vector(const Vector& z)>& half_gradient,
                          const RecordingScores& scores, const ConstVectorRef& z, double step) {
  const auto n = static_cast<Index>(scores.parameters.size());
  Matrix hessian(n, n);
  for (Index i = 0; i < n; ++i) {
    const Index at = scores.parameters[static_cast<std::size_t>(i)];
    Vector up = z, down = z;
    up[at] += step * scores.scale[i];
    down[at] -= step * scores.scale[i];
    const Vector apart = half_gradient(up) - half_gradient(down);
    hessian.col(i) = scores.scale.cwiseProduct(Vector(apart(scores.parameters))) / (2 * step);
  }
  return (hessian + hessian.transpose()) / 2;
}

LeaveOneOut::LeaveOneOut(const RecordingScores& scores, const Matrix& exact)
    : scores_(scores),
      kinds_(kinds_of(scores.kinds)),
      general_(general_refusal(scores)),
      covariances_(scores.g, scores.h),
      leverages_(covariances_.leverages()) {
  if (general_.refused != NoInterval::None) return;
  const Matrix shared = shared_directions(covariances_);
  basis_ = covariances_.basis() * shared;
  for (std::size_t n = 0; n < scores.size(); ++n) {
    g_.push_back(shared.transpose() * covariances_.scores()[n]);
    h_.push_back(shared.transpose() * covariances_.informations()[n] * shared);
  }
  if (exact.size() > 0) {
    eigenvalues_ = Eigen::SelfAdjointEigenSolver<Matrix>(exact, Eigen::EigenvaluesOnly).eigenvalues();
    exact_ = exact.allFinite() && factorise(basis_.transpose() * exact * basis_);
  }
  if (!exact_) factorise(Matrix::Identity(basis_.cols(), basis_.cols()));
}

bool LeaveOneOut::factorise(const Matrix& curvature) {
  const Index k = basis_.cols();
  const auto count = static_cast<double>(g_.size());
  const Eigen::LLT<Matrix> all(curvature);
  if (all.info() != Eigen::Success) return false;
  Matrix moves(k, static_cast<Index>(g_.size()));
  for (std::size_t n = 0; n < g_.size(); ++n) {
    const Matrix left = curvature - h_[n] - (curvature - Matrix::Identity(k, k)) / count;
    const Eigen::LLT<Matrix> factor(left);
    if (factor.info() != Eigen::Success) return false;
    moves.col(static_cast<Index>(n)) = factor.solve(g_[n]);
  }
  inverse_ = all.solve(Matrix::Identity(k, k));
  moves_ = std::move(moves);
  return true;
}

Interval LeaveOneOut::interval(const Vector& c) const {
  return interval(c, 0);
}

Interval LeaveOneOut::interval(const Vector& c, double scatter) const {
  if (general_.refused != NoInterval::None) return general_;
  if (covariances_.undetermined(c))
    return refusal(NoInterval::Undetermined, "these drives cannot tell: any value fits");
  if (Interval alone = refused_by_leverage(scores_, covariances_, c); alone.refused != NoInterval::None)
    return alone;
  const auto count = static_cast<double>(g_.size());
  const Vector at = basis_.transpose() * c, k = inverse_ * at;
  const Vector moved = moves_.transpose() * at;
  double sum = 0, squares = 0;
  for (const Matrix& h : h_) {
    const double w = k.dot(h * k);
    sum += w;
    squares += w * w;
  }
  Interval found;
  found.df = squares > 0 ? std::max(2.0, sum * sum / squares) : 2.0;
  const double variance = (count - 1) / count * (moved.array() - moved.mean()).square().sum();
  found.deviation = std::sqrt(variance + scatter * scatter);
  found.half_width = t_quantile(found.df) * found.deviation;
  if (*std::min_element(kinds_.counts.begin(), kinds_.counts.end()) < 2) return found;
  Vector means = Vector::Zero(static_cast<Index>(kinds_.names.size()));
  for (Index n = 0; n < moved.size(); ++n) {
    const std::size_t kind = kinds_.of[static_cast<std::size_t>(n)];
    means[static_cast<Index>(kind)] += moved[n] / static_cast<double>(kinds_.counts[kind]);
  }
  double same = 0;
  for (Index n = 0; n < moved.size(); ++n) {
    const std::size_t kind = kinds_.of[static_cast<std::size_t>(n)];
    const auto repeats = static_cast<double>(kinds_.counts[kind]);
    const double factor = std::max(1.0, 0.8 * repeats / (repeats - 1));
    same += factor * std::pow(moved[n] - means[static_cast<Index>(kind)], 2);
  }
  found.same_df = (count - static_cast<double>(kinds_.names.size())) / count * found.df;
  found.same_deviation = std::sqrt(same + scatter * scatter);
  found.same_half_width = t_quantile(found.same_df) * found.same_deviation;
  return found;
}

Interval jackknife_interval(const RecordingScores& scores, const RecordingCovariances& covariances,
                            const Vector& c) {
  if (Interval none = general_refusal(scores); none.refused != NoInterval::None) return none;
  if (covariances.undetermined(c))
    return refusal(NoInterval::Undetermined, "these drives cannot tell: any value fits");
  if (Interval alone = refused_by_leverage(scores, covariances, c); alone.refused != NoInterval::None)
    return alone;
  Interval found;
  found.df = covariances.df_cr3(c);
  found.deviation = std::sqrt(covariances.cr3_variance(c));
  if (!(found.df >= 1)) {
    Interval few = refusal(NoInterval::TooFewDegreesOfFreedom,
                           fmt::format("{:.2f} degrees of freedom: too few recordings tell it", found.df));
    few.deviation = found.deviation;
    few.df = found.df;
    return few;
  }
  found.half_width = t_quantile(found.df) * found.deviation;
  return found;
}

}  // namespace odobench
