// One descent of the covariance matrix adaptation evolution strategy, (mu/mu_w, lambda)-CMA-ES, in R^m.
//
// Equation numbers are those of N. Hansen, The CMA Evolution Strategy: A Tutorial, arXiv:1604.00772:
//     x_k = mean + sigma y_k,  y_k = B D z_k,  z_k ~ N(0, I),  C = B D^2 B'                         (38)-(40)
//     mean <- mean + sigma <y>_w,   <y>_w = sum_{i <= mu} w_i y_{i:lambda}                          (41)-(42)
//     p_s <- (1 - c_s) p_s + sqrt(c_s (2 - c_s) mu_eff) C^(-1/2) <y>_w                                (43)
//     sigma <- sigma exp(c_s / d_s (|p_s| / E|N(0,I)| - 1))                                           (44)
//     p_c <- (1 - c_c) p_c + h_s sqrt(c_c (2 - c_c) mu_eff) <y>_w                                     (45)
//     C <- (1 + c_1 d(h_s) - c_1 - c_mu sum w) C + c_1 p_c p_c' + c_mu sum_i w'_i y_i y_i'          (46)-(47)
// with the default weights and rates of its table 1; the worse half has negative weights (active update) on
// request: w'_i = w_i m / |C^(-1/2) y_i|^2 for those, w_i otherwise. The decomposition of C is renewed every
// 1 / (10 m (c_1 + c_mu)) generations.
#pragma once

#include <deque>
#include <optional>
#include <string>

#include "base/random.hpp"
#include "problems/problem.hpp"

namespace odobench {

struct DescentEnd {
  std::string reason;
  bool by_tolerance =
      false;  // costs, steps or the resolution of doubles; not axis ratio, stagnation, overflow
};

class CmaDescent {
 public:
  // mean (m), sigma > 0, population >= 2.
  CmaDescent(const Vector& mean, double sigma, int population, bool active);

  // lambda samples, m x lambda.
  Matrix sample(Random& random);
  // costs (lambda) of the samples last drawn, +infinity for refused ones.
  void update(const Vector& costs);

  int population() const { return population_; }
  const Vector& mean() const { return mean_; }
  double sigma() const { return sigma_; }
  // Largest axis ratio of the sampling distribution, sqrt(cond C).
  double axis_ratio() const;
  // Why the descent is over, nothing while it goes on. Best costs of the last 10 + 30 m / lambda generations
  // and all costs of the newest lie within cost_tolerance |J|; every standard deviation is below
  // step_tolerance times the first sigma; axis ratio above 1e7; a step along an axis or coordinate no longer
  // changes the mean; no progress of the median over a long history; a covariance that is no longer finite.
  std::optional<DescentEnd> finished(double cost_tolerance, double step_tolerance) const;

 private:
  void set_rates();
  void decompose();
  void remember(const Vector& sorted);
  bool stagnated() const;
  bool step_without_effect() const;

  Eigen::Index m_;
  int population_;
  bool active_;
  double sigma_, first_sigma_;
  Vector mean_, p_sigma_, p_c_;
  Matrix c_, b_;
  Vector d_;         // square roots of the eigenvalues
  Matrix y_;         // the steps last drawn
  Vector weights_;   // lambda, descending
  int parents_ = 0;  // mu
  double mu_eff_ = 0, c_sigma_ = 0, d_sigma_ = 0, c_c_ = 0, c_1_ = 0, c_mu_ = 0, chi_ = 0;
  int generation_ = 0, decomposed_at_ = 0;
  std::deque<double> bests_, medians_;
  double newest_range_ = 0;
};

}  // namespace odobench
