#include "solvers/population/cma_core.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace odobench {

CmaDescent::CmaDescent(const Vector& mean, double sigma, int population, bool active)
    : m_(mean.size()),
      population_(population),
      active_(active),
      sigma_(sigma),
      first_sigma_(sigma),
      mean_(mean) {
  p_sigma_ = p_c_ = Vector::Zero(m_);
  c_ = b_ = Matrix::Identity(m_, m_);
  d_ = Vector::Ones(m_);
  set_rates();
}

void CmaDescent::set_rates() {
  const auto n = static_cast<double>(m_);
  const Eigen::Index lambda = population_;
  parents_ = population_ / 2;
  Vector raw(lambda);  // (49)
  for (Eigen::Index i = 0; i < lambda; ++i)
    raw[i] = std::log(0.5 * static_cast<double>(lambda + 1)) - std::log(static_cast<double>(i + 1));
  const auto effective = [](const auto& w) { return w.sum() * w.sum() / w.squaredNorm(); };
  mu_eff_ = effective(raw.head(parents_));
  c_sigma_ = (mu_eff_ + 2.0) / (n + mu_eff_ + 5.0);  // (55)
  d_sigma_ = 1.0 + 2.0 * std::max(0.0, std::sqrt((mu_eff_ - 1.0) / (n + 1.0)) - 1.0) + c_sigma_;
  c_c_ = (4.0 + mu_eff_ / n) / (n + 4.0 + 2.0 * mu_eff_ / n);  // (56)
  c_1_ = 2.0 / ((n + 1.3) * (n + 1.3) + mu_eff_);              // (57)
  c_mu_ = std::min(1.0 - c_1_,
                   2.0 * (0.25 + mu_eff_ - 2.0 + 1.0 / mu_eff_) / ((n + 2.0) * (n + 2.0) + mu_eff_));  // (58)
  chi_ = std::sqrt(n) * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n));

  weights_ = Vector::Zero(lambda);  // (50)-(53)
  weights_.head(parents_) = raw.head(parents_) / raw.head(parents_).sum();
  const auto worse = raw.tail(lambda - parents_);
  const double worse_sum = worse.cwiseMin(0.0).cwiseAbs().sum();
  if (!active_ || worse_sum <= 0 || c_mu_ <= 0) return;
  const double mu_eff_worse = effective(worse);
  const double limit = std::min(
      {1.0 + c_1_ / c_mu_, 1.0 + 2.0 * mu_eff_worse / (mu_eff_ + 2.0), (1.0 - c_1_ - c_mu_) / (n * c_mu_)});
  weights_.tail(lambda - parents_) = worse.cwiseMin(0.0) * (limit / worse_sum);
}

Matrix CmaDescent::sample(Random& random) {
  if (generation_ == 0 ||
      (generation_ - decomposed_at_) * 10.0 * static_cast<double>(m_) * (c_1_ + c_mu_) >= 1.0)
    decompose();
  y_.resize(m_, population_);
  for (Eigen::Index k = 0; k < y_.cols(); ++k)
    for (Eigen::Index i = 0; i < m_; ++i) y_(i, k) = random.normal();
  y_ = b_ * (d_.asDiagonal() * y_);
  return (sigma_ * y_).colwise() + mean_;
}

void CmaDescent::decompose() {
  decomposed_at_ = generation_;
  c_ = 0.5 * (c_ + c_.transpose()).eval();
  if (!c_.allFinite()) return;
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(c_);
  b_ = eigen.eigenvectors();
  // The rounding error of an eigenvalue is relative to the largest one; beyond that an axis carries no
  // information.
  const double floor = 1e-16 * eigen.eigenvalues().maxCoeff();
  d_ = eigen.eigenvalues().cwiseMax(floor).cwiseSqrt();
}

void CmaDescent::update(const Vector& costs) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(population_));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](Eigen::Index a, Eigen::Index b) { return costs[a] < costs[b]; });
  ++generation_;

  Vector step = Vector::Zero(m_);
  for (int i = 0; i < parents_; ++i) step += weights_[i] * y_.col(order[static_cast<std::size_t>(i)]);
  mean_ += sigma_ * step;

  const auto whitened = [this](const Vector& y) { return Vector((b_.transpose() * y).cwiseQuotient(d_)); };
  p_sigma_ =
      (1.0 - c_sigma_) * p_sigma_ + std::sqrt(c_sigma_ * (2.0 - c_sigma_) * mu_eff_) * (b_ * whitened(step));
  const double length = p_sigma_.norm();
  const double unbiased = std::sqrt(1.0 - std::pow(1.0 - c_sigma_, 2.0 * generation_));
  const bool h = length / unbiased < (1.4 + 2.0 / (static_cast<double>(m_) + 1.0)) * chi_;
  p_c_ = (1.0 - c_c_) * p_c_;
  if (h) p_c_ += std::sqrt(c_c_ * (2.0 - c_c_) * mu_eff_) * step;

  const double lost = h ? 0.0 : c_c_ * (2.0 - c_c_);
  c_ *= 1.0 + c_1_ * lost - c_1_ - c_mu_ * weights_.sum();
  c_ += c_1_ * p_c_ * p_c_.transpose();
  for (int i = 0; i < population_; ++i) {
    const Vector y = y_.col(order[static_cast<std::size_t>(i)]);
    double w = weights_[i];
    if (w == 0) continue;
    if (w < 0) w *= static_cast<double>(m_) / std::max(whitened(y).squaredNorm(), 1e-300);
    c_ += c_mu_ * w * y * y.transpose();
  }
  sigma_ *= std::exp(std::min(1.0, c_sigma_ / d_sigma_ * (length / chi_ - 1.0)));

  Vector sorted(population_);
  for (int i = 0; i < population_; ++i) sorted[i] = costs[order[static_cast<std::size_t>(i)]];
  remember(sorted);
}

void CmaDescent::remember(const Vector& sorted) {
  // Equal flanks mean that the step is too small to tell candidates apart: widen it (Hansen, appendix B.2).
  if (sorted[0] == sorted[std::min<Eigen::Index>(population_ - 1, population_ / 4)] &&
      std::isfinite(sorted[0]))
    sigma_ *= std::exp(0.2 + c_sigma_ / d_sigma_);
  newest_range_ = sorted[population_ - 1] - sorted[0];
  bests_.push_back(sorted[0]);
  medians_.push_back(sorted[population_ / 2]);
  const std::size_t longest = 20000;
  if (bests_.size() > longest) {
    bests_.pop_front();
    medians_.pop_front();
  }
}

double CmaDescent::axis_ratio() const {
  return d_.maxCoeff() / d_.minCoeff();
}

bool CmaDescent::stagnated() const {
  const auto length = std::min<std::size_t>(
      20000, static_cast<std::size_t>(
                 std::max(120.0 + 30.0 * static_cast<double>(m_) / population_, 0.2 * generation_)));
  if (bests_.size() < length) return false;
  const auto median = [](const std::deque<double>& values, std::size_t first, std::size_t count) {
    std::vector<double> part(values.begin() + static_cast<std::ptrdiff_t>(first),
                             values.begin() + static_cast<std::ptrdiff_t>(first + count));
    std::nth_element(part.begin(), part.begin() + static_cast<std::ptrdiff_t>(count / 2), part.end());
    return part[count / 2];
  };
  const std::size_t third = length * 3 / 10;
  const std::size_t old = bests_.size() - length;
  const std::size_t recent = bests_.size() - third;
  return median(bests_, recent, third) >= median(bests_, old, third) &&
         median(medians_, recent, third) >= median(medians_, old, third);
}

bool CmaDescent::step_without_effect() const {
  const Eigen::Index axis = generation_ % m_;
  const Vector along = mean_ + 0.1 * sigma_ * d_[axis] * b_.col(axis);
  if (along == mean_) return true;
  for (Eigen::Index i = 0; i < m_; ++i)
    if (mean_[i] == mean_[i] + 0.2 * sigma_ * std::sqrt(c_(i, i))) return true;
  return false;
}

std::optional<DescentEnd> CmaDescent::finished(double cost_tolerance, double step_tolerance) const {
  if (generation_ == 0) return std::nullopt;
  if (!c_.allFinite() || !mean_.allFinite() || !std::isfinite(sigma_))
    return DescentEnd{"the covariance is no longer finite"};
  const auto window =
      static_cast<std::size_t>(10.0 + std::ceil(30.0 * static_cast<double>(m_) / population_));
  if (bests_.size() >= window) {
    const auto first = bests_.end() - static_cast<std::ptrdiff_t>(window);
    const auto [low, high] = std::minmax_element(first, bests_.end());
    const double range = std::max(*high - *low, newest_range_);
    if (std::isfinite(*low) && range <= cost_tolerance * std::abs(*low))
      return DescentEnd{fmt::format("cost range {:.2g} <= {:.2g} times the cost", range, cost_tolerance),
                        true};
  }
  const double largest = sigma_ * std::max(p_c_.cwiseAbs().maxCoeff(), std::sqrt(c_.diagonal().maxCoeff()));
  if (largest <= step_tolerance * first_sigma_)
    return DescentEnd{fmt::format("standard deviation {:.2g} <= {:.2g} times the first",
                                  largest / first_sigma_, step_tolerance),
                      true};
  if (axis_ratio() > 1e7) return DescentEnd{fmt::format("axis ratio {:.2g} > 1e7", axis_ratio())};
  if (step_without_effect())
    return DescentEnd{"a step of 0.1 standard deviations no longer changes the mean", true};
  if (stagnated())
    return DescentEnd{
        fmt::format("no better median in {} generations", bests_.size() < 20000 ? generation_ : 20000)};
  return std::nullopt;
}

}  // namespace odobench
