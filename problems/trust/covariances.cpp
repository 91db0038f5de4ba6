#include "problems/trust/covariances.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "problems/trust/recording_scores.hpp"

namespace odobench {

using Eigen::Index;

namespace {

constexpr double kRounding = 1e-14;     // of eigenvalues of a matrix with unit diagonal, per row
constexpr double kUndetermined = 1e-6;  // part of a unit vector
constexpr double kSystematic = 1e-6;    // probability

void require_same_count(const std::vector<std::string>& kinds, std::size_t recordings) {
  if (kinds.size() != recordings)
    throw std::invalid_argument(
        fmt::format("covariances: {} kinds for {} recordings", kinds.size(), recordings));
}

Matrix outer_sum(const std::vector<Vector>& list) {
  Matrix sum = Matrix::Zero(list.front().size(), list.front().size());
  for (const Vector& v : list) sum += v * v.transpose();
  return sum;
}

std::vector<Vector> sums_of_kinds(const std::vector<Vector>& list, const KindsOfDrives& kinds) {
  std::vector<Vector> sums(kinds.names.size(), Vector::Zero(list.front().size()));
  for (std::size_t n = 0; n < list.size(); ++n) sums[kinds.of[n]] += list[n];
  return sums;
}

}  // namespace

RecordingCovariances::RecordingCovariances(const std::vector<Vector>& g, const std::vector<Matrix>& h) {
  if (g.empty() || g.size() != h.size() || g.front().size() == 0)
    throw std::invalid_argument(fmt::format(
        "covariances: {} scores and {} informations, expected as many, and a parameter", g.size(), h.size()));
  const Index n = g.front().size();
  Matrix sum = Matrix::Zero(n, n);
  for (std::size_t i = 0; i < g.size(); ++i) {
    if (g[i].size() != n || h[i].rows() != n || h[i].cols() != n)
      throw std::invalid_argument(fmt::format("covariances: recording {} has other parameters", i + 1));
    sum += h[i];
  }
  size_ = sum.diagonal().cwiseMax(0.0).cwiseSqrt();
  const Vector inverse = (size_.array() > 0).select(1.0 / size_.array(), 0.0);
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(inverse.asDiagonal() * sum * inverse.asDiagonal());
  const Vector values = eigen.eigenvalues();
  const double noise = kRounding * static_cast<double>(n) * std::max(values[n - 1], 0.0);
  const Index told = (values.array() > noise).count();
  kept_ = eigen.eigenvectors().rightCols(told);
  basis_ = inverse.asDiagonal() * kept_ * values.tail(told).cwiseSqrt().cwiseInverse().asDiagonal();
  for (std::size_t i = 0; i < g.size(); ++i) {
    g_.push_back(basis_.transpose() * g[i]);
    h_.push_back(basis_.transpose() * h[i] * basis_);
    const Eigen::SelfAdjointEigenSolver<Matrix> own(h_.back());
    values_.push_back(own.eigenvalues());
    directions_.push_back(own.eigenvectors());
    left_.push_back(power(i, -1));
  }
  moves_.resize(told, static_cast<Index>(g.size()));
  for (std::size_t i = 0; i < g.size(); ++i) moves_.col(static_cast<Index>(i)) = left_[i] * g_[i];
}

Matrix RecordingCovariances::naive(double cost, Index residuals) const {
  const Index freedom = residuals - basis_.rows();
  if (freedom <= 0)
    throw std::invalid_argument(
        fmt::format("covariances: {} residuals for {} parameters", residuals, basis_.rows()));
  return cost / static_cast<double>(freedom) * basis_ * basis_.transpose();
}

Matrix RecordingCovariances::sandwich() const {
  const auto count = static_cast<double>(g_.size());
  return from_whitened(count / (count - 1) * outer_sum(g_));
}

Matrix RecordingCovariances::power(std::size_t n, double exponent) const {
  const Vector left = (1 - values_[n].array()).max(std::numeric_limits<double>::min()).pow(exponent);
  return directions_[n] * left.asDiagonal() * directions_[n].transpose();
}

Matrix RecordingCovariances::cr2() const {
  std::vector<Vector> moved;
  for (std::size_t n = 0; n < g_.size(); ++n) moved.push_back(power(n, -0.5) * g_[n]);
  return from_whitened(outer_sum(moved));
}

Matrix RecordingCovariances::cr3() const {
  const auto count = static_cast<double>(g_.size());
  return from_whitened((count - 1) / count * moves_ * moves_.transpose());
}

double RecordingCovariances::cr3_variance(const Vector& c) const {
  const auto count = static_cast<double>(g_.size());
  return (count - 1) / count * (moves_.transpose() * whitened(c)).squaredNorm();
}

Matrix RecordingCovariances::stratified(const std::vector<std::string>& kinds) const {
  require_same_count(kinds, g_.size());
  const KindsOfDrives all = kinds_of(kinds);
  const std::vector<Vector> sums = sums_of_kinds(g_, all);
  Matrix middle = Matrix::Zero(basis_.cols(), basis_.cols());
  for (std::size_t n = 0; n < g_.size(); ++n) {
    const auto count = static_cast<double>(all.counts[all.of[n]]);
    if (count < 2) continue;  // a single drive shows no spread
    const Vector apart = g_[n] - sums[all.of[n]] / count;
    middle += count / (count - 1) * apart * apart.transpose();
  }
  return from_whitened(middle);
}

Matrix RecordingCovariances::between_kinds(const std::vector<std::string>& kinds) const {
  require_same_count(kinds, g_.size());
  const KindsOfDrives all = kinds_of(kinds);
  const auto count = static_cast<double>(all.names.size());
  return from_whitened(count / (count - 1) * outer_sum(sums_of_kinds(g_, all)));
}

double RecordingCovariances::satterthwaite(const Vector& c, double exponent) const {
  const auto count = static_cast<Index>(g_.size());
  const Vector at = whitened(c);
  Matrix v(at.size(), count);  // H_n w_n
  Vector own(count);           // w_n'H_n w_n
  for (Index n = 0; n < count; ++n) {
    const auto place = static_cast<std::size_t>(n);
    const Vector w = exponent == 1 ? Vector(left_[place] * at) : Vector(power(place, -exponent) * at);
    v.col(n) = h_[place] * w;
    own[n] = w.dot(v.col(n));
  }
  const Matrix m = Matrix(own.asDiagonal()) - v.transpose() * v;
  return m.trace() * m.trace() / m.squaredNorm();
}

double RecordingCovariances::df_cr2(const Vector& c) const {
  return satterthwaite(c, 0.5);
}
double RecordingCovariances::df_cr3(const Vector& c) const {
  return satterthwaite(c, 1);
}

Vector RecordingCovariances::leverages() const {
  Vector all(static_cast<Index>(values_.size()));
  for (Index n = 0; n < all.size(); ++n) {
    const Vector& values = values_[static_cast<std::size_t>(n)];
    all[n] = values.size() == 0 ? 0 : values[values.size() - 1];
  }
  return all;
}

bool RecordingCovariances::undetermined(const Vector& c) const {
  const Vector inverse = (size_.array() > 0).select(1.0 / size_.array(), 0.0);
  for (Index i = 0; i < c.size(); ++i)
    if (size_[i] == 0 && c[i] != 0) return true;
  const Vector scaled = inverse.cwiseProduct(c);
  const Vector lost = scaled - kept_ * (kept_.transpose() * scaled);
  return lost.norm() > kUndetermined * scaled.norm();
}

double RecordingCovariances::share_of(std::size_t n, double limit, const Vector& c) const {
  const Vector at = whitened(c);
  double share = 0;
  for (Index k = 0; k < values_[n].size(); ++k)
    if (values_[n][k] > limit) share += std::pow(directions_[n].col(k).dot(at), 2);
  return at.squaredNorm() > 0 ? share / at.squaredNorm() : 0;
}

KindTest kind_test(const std::vector<Vector>& g, const std::vector<Matrix>& h,
                   const std::vector<std::string>& kinds) {
  KindTest test;
  require_same_count(kinds, g.size());
  const KindsOfDrives all = kinds_of(kinds);
  const auto repeated =
      std::count_if(all.counts.begin(), all.counts.end(), [](std::size_t k) { return k > 1; });
  const auto between = static_cast<double>(all.names.size()) - 1;
  const auto within = static_cast<double>(g.size()) - static_cast<double>(all.names.size());
  if (repeated < 2) return test;
  test.possible = true;
  test.df_between = between;
  test.df_within = within;
  Matrix sum = Matrix::Zero(g.front().size(), g.front().size());
  for (const Matrix& one : h) sum += one;
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(sum);
  const boost::math::fisher_f distribution(between, within);
  for (Index k = sum.rows() - 1; k >= 0; --k) {
    Vector means = Vector::Zero(static_cast<Index>(all.names.size()));
    Vector u(static_cast<Index>(g.size()));
    for (Index n = 0; n < u.size(); ++n) {
      const std::size_t place = static_cast<std::size_t>(n), kind = all.of[place];
      u[n] = eigen.eigenvectors().col(k).dot(g[place]);
      means[static_cast<Index>(kind)] += u[n] / static_cast<double>(all.counts[kind]);
    }
    double inside = 0, outside = 0;
    for (Index n = 0; n < u.size(); ++n) {
      const double mean = means[static_cast<Index>(all.of[static_cast<std::size_t>(n)])];
      inside += std::pow(u[n] - mean, 2);
      outside += std::pow(mean - u.mean(), 2);
    }
    const double f = inside > 0 ? (outside / between) / (inside / within) : 0;
    test.all_f.push_back(f);
    test.f = std::max(test.f, f);
  }
  test.p = test.f > 0 ? boost::math::cdf(boost::math::complement(distribution, test.f)) : 1;
  test.systematic = test.p * static_cast<double>(test.all_f.size()) < kSystematic;
  return test;
}

double t_quantile(double df) {
  return boost::math::quantile(boost::math::students_t(df), 0.975);
}

}  // namespace odobench
