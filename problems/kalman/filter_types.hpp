// What filters take and give besides models: options, innovations, records for a smoother; their checks.
#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <cmath>
#include <stdexcept>
#include <string>

#include "base/angle.hpp"
#include "problems/problem.hpp"

namespace odobench {

// Throws std::invalid_argument "FIELD is VALUE, expected EXPECTED" unless it is good and finite.
inline void require(bool good, const char* field, double value, const char* expected) {
  if (!good || !std::isfinite(value))
    throw std::invalid_argument(fmt::format("{} is {}, expected {}", field, value, expected));
}

enum class FilterKind { Extended, Unscented };

// Points at x +- sqrt(n + lambda) L_j with lambda = alpha^2 (n + kappa) - n; mean weights lambda/(n+lambda)
// and
// 1/(2(n+lambda)), the centre's covariance weight is larger by 1 - alpha^2 + beta. A negative centre weight
// of the covariance could make it indefinite and is refused.
struct UnscentedOptions {
  double alpha = 1;
  double beta = 2;  // right for Gaussians to fourth order
  double kappa = 0;
};

// n + lambda, the centre's weights, the weight of the others, for n dimensions. Throws std::invalid_argument
// when n + lambda is not positive or the centre's covariance weight is negative.
struct SigmaWeights {
  double spread = 0, mean0 = 0, covariance0 = 0, other = 0;
};
inline SigmaWeights sigma_weights(const UnscentedOptions& o, Eigen::Index n) {
  const auto size = static_cast<double>(n);
  SigmaWeights w;
  w.spread = o.alpha * o.alpha * (size + o.kappa);
  if (!(w.spread > 0))
    throw std::invalid_argument("sigma points: alpha^2 (n + kappa) = " + std::to_string(w.spread) +
                                ", expected > 0");
  w.mean0 = (w.spread - size) / w.spread;
  w.covariance0 = w.mean0 + 1 - o.alpha * o.alpha + o.beta;
  w.other = 0.5 / w.spread;
  if (!(w.covariance0 >= 0))
    throw std::invalid_argument("sigma points: the centre's covariance weight is " +
                                std::to_string(w.covariance0) +
                                ", expected >= 0 (a larger alpha, beta or kappa)");
  return w;
}

struct KalmanOptions {
  FilterKind kind = FilterKind::Extended;
  UnscentedOptions unscented;
  // (4.7) of J. Vitko's thesis read to the letter: the innovation is z - h(x_n) with the state before the
  // prediction. The estimate then leads by the last increment of the odometry. For comparison only.
  bool literal_47 = false;
};

// z - h, its covariance Sy Sy', NIS = nu' (Sy Sy')^-1 nu, log det(Sy Sy').
template <int Z>
struct Innovation {
  Eigen::Matrix<double, Z, 1> nu;
  Eigen::Matrix<double, Z, Z> factor;
  double nis = 0;
  double log_det = 0;
  bool accepted = true;
};

// A scalar measurement of the process: its value differs from what is expected at w = 0 by `innovation`, with
// derivatives hx to the state and hw to the noise and standard deviation sigma. A gyro that corrects the yaw
// rate of a step.
template <int N, int W>
struct ProcessMeasurement {
  Eigen::Matrix<double, 1, N> hx;
  Eigen::Matrix<double, 1, W> hw;
  double innovation = 0;
  double sigma = 0;
  bool touches_state = false;  // hx is not zero
};

// Deviations before and after a prediction, joined column by column: before before' = P, after after' = P of
// the next instant, before after' = their covariance. What a smoother needs.
struct PredictionRecord {
  Vector x, x_next;
  Matrix before, after;
};

// y of l y = b and of l' y = b, l lower triangular.
template <int Z, int C>
Eigen::Matrix<double, Z, C> forward_solved(const Eigen::Matrix<double, Z, Z>& l,
                                           Eigen::Matrix<double, Z, C> b) {
  for (Eigen::Index i = 0; i < b.rows(); ++i) {
    const double d = 1 / l(i, i);
    for (Eigen::Index c = 0; c < b.cols(); ++c) {
      double sum = b(i, c);
      for (Eigen::Index j = 0; j < i; ++j) sum -= l(i, j) * b(j, c);
      b(i, c) = sum * d;
    }
  }
  return b;
}
template <int Z, int C>
Eigen::Matrix<double, Z, C> backward_solved(const Eigen::Matrix<double, Z, Z>& l,
                                            Eigen::Matrix<double, Z, C> b) {
  for (Eigen::Index i = b.rows(); i-- > 0;) {
    const double d = 1 / l(i, i);
    for (Eigen::Index c = 0; c < b.cols(); ++c) {
      double sum = b(i, c);
      for (Eigen::Index j = i + 1; j < b.rows(); ++j) sum -= l(j, i) * b(j, c);
      b(i, c) = sum * d;
    }
  }
  return b;
}

}  // namespace odobench
