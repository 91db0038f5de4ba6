// Kalman filters on one small model interface, in square-root form.
//
// The estimate is a mean x (n) and a lower-triangular factor S of its covariance, P = S S'. Prediction and
// update build an array M with M M' = the new covariance and triangularise it (triangular.hpp). P is never
// formed or subtracted from, so it stays symmetric and positive semidefinite whatever the gain and however
// long the run; nothing is ever repaired.
//
// Equations, with L the factor of the joint covariance of state and process noise (x, w), L = diag(S, Lq) at
// first:
//     prediction   x = f(x, w, u, dt),  S = tri[ [F G] L ]                                     (extended)
//     update       A = H S,  Sy = tri[A, Lr],  K = S A' (Sy Sy')^-1
//                  x = x + K (z - h(x)),  S = tri[ S - K A, K Lr ]     Joseph's form (I-KH) P (I-KH)' + K R
//                  K', factored
// With sigma points the arrays hold weighted deviations instead (unscented; S. Julier, J. Uhlmann 1997;
// update in the form of I. Arasaratnam, S. Haykin, IEEE TAC 54(6), 2009): S = tri[ dX - K dZ, K Lr ], which
// needs no downdate. On a linear model the extended filter is the linear Kalman filter.
//
// A process model M has
//     static constexpr int kStates, kNoises;          (Eigen::Dynamic allowed, both together)
//     using Input = ...;
//     State move(x, w, u, dt) const;                  f; w (p) the process noise, mean 0, covariance Lq Lq'
//     State linearise(x, w, u, dt, F, G) const;       fills df/dx (n x n) and df/dw (n x p), returns f: what
//                                                     they share is computed once
// and a sensor
//     static constexpr int kSize;
//     Value measure(x) const;  Matrix jacobian(x) const;      h (m), dh/dx (m x n)
//     void wrap(Value& difference) const;                     differences of angles to (-pi, pi]
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <stdexcept>
#include <string>

#include "problems/kalman/covariance.hpp"
#include "problems/kalman/filter_types.hpp"
#include "problems/kalman/triangular.hpp"

namespace odobench {

template <class M>
class KalmanFilter {
 public:
  static constexpr int kN = M::kStates, kW = M::kNoises;
  static constexpr int kJoint = kN == Eigen::Dynamic ? Eigen::Dynamic : kN + kW;
  static constexpr int kPoints = kN == Eigen::Dynamic ? Eigen::Dynamic : 2 * (kN + kW) + 1;
  using State = Eigen::Matrix<double, kN, 1>;
  using Square = Eigen::Matrix<double, kN, kN>;
  using Noise = Eigen::Matrix<double, kW, 1>;
  using NoiseFactor = Eigen::Matrix<double, kW, kW>;
  using NoiseMap = Eigen::Matrix<double, kN, kW>;
  using Input = typename M::Input;

  // Throws std::invalid_argument when sizes do not match, x is not finite, p is no covariance (zero
  // eigenvalues are allowed: a start that is known), or the sigma-point weights are not usable.
  KalmanFilter(M model, const KalmanOptions& options, const State& x, const ConstMatrixRef& p);

  const M& model() const { return model_; }
  const State& state() const { return x_; }
  const Square& factor() const { return s_; }
  Square covariance() const { return squared<kN>(s_); }
  void restore(const State& x, const Square& factor) {
    x_ = before_ = x;
    s_ = factor;
  }

  // One step; lq factors the covariance of w over it. `measurement` (may be null) corrects w, and the state
  // through what they share, beforehand, unless its NIS exceeds `gate`. Throws std::runtime_error when the
  // result is not finite.
  Innovation<1> predict(const Input& u, const NoiseFactor& lq, double dt,
                        const ProcessMeasurement<kN, kW>* measurement = nullptr, double gate = kNoGate,
                        PredictionRecord* record = nullptr);

  // lr factors the covariance of z (lower triangular). Above `gate` the estimate stays as it was and accepted
  // is false. Throws std::runtime_error when the innovation has no positive definite covariance or is not
  // finite, std::invalid_argument when sizes do not fit.
  template <class S>
  Innovation<S::kSize> update(const S& sensor, const Eigen::Matrix<double, S::kSize, 1>& z,
                              const Eigen::Matrix<double, S::kSize, S::kSize>& lr, double gate = kNoGate);

  // x -> t x, P -> t P t'. For states that are copies of others.
  void transform(const Square& t) {
    x_ = before_ = (t * x_).eval();
    s_ = lower_triangular<kN, kN>(t * s_);
  }

  static constexpr double kNoGate = 1e300;

 private:
  using Joint = Eigen::Matrix<double, kJoint, kJoint>;
  // Corrects a vector v of covariance l l' by one number: innovation = h'v + an error of this sigma. Fills
  // the gain (v += gain * innovation is the caller's to do) and l.
  template <int Size>
  static Innovation<1> correct_by_scalar(const Eigen::Matrix<double, Size, 1>& h, double innovation,
                                         double sigma, double gate, Eigen::Matrix<double, Size, Size>& l,
                                         Eigen::Matrix<double, Size, 1>& gain);
  Innovation<1> correct_noise(Noise& w, NoiseFactor& lq, const ProcessMeasurement<kN, kW>& m,
                              double gate) const;
  Innovation<1> correct_joint(Noise& w, Joint& l, const ProcessMeasurement<kN, kW>& m, double gate);
  void extended_step(const Input& u, const Noise& w, const Joint& l, double dt, PredictionRecord* record);
  void extended_step(const Input& u, const Noise& w, const NoiseFactor& lq, double dt);
  void unscented_step(const Input& u, const Noise& w, const Joint& l, double dt, PredictionRecord* record);
  template <class S>
  Innovation<S::kSize> unscented_update(const S& sensor, const Eigen::Matrix<double, S::kSize, 1>& z,
                                        const Eigen::Matrix<double, S::kSize, S::kSize>& lr, double gate);
  // Corrects the state with out.nu: dx (n x count) and dz (m x count) are deviations of the state and of the
  // predicted measurement, P = dx dx', cross covariance dx dz', covariance of the innovation dz dz' + lr lr'.
  // Fills the rest of out.
  template <int Z, int C>
  void correct(const Eigen::Matrix<double, kN, C>& dx, const Eigen::Matrix<double, Z, C>& dz,
               const Eigen::Matrix<double, Z, Z>& lr, double gate, Innovation<Z>& out);
  template <int Z>
  static void measure_innovation(Innovation<Z>& out, double gate);
  void require_finite(const char* where) const;

  M model_;
  KalmanOptions options_;
  State x_, before_;  // before_: ahead of the last prediction
  Square s_;
};

template <class M>
KalmanFilter<M>::KalmanFilter(M model, const KalmanOptions& options, const State& x, const ConstMatrixRef& p)
    : model_(std::move(model)), options_(options), x_(x), before_(x) {
  if (p.rows() != x.size())
    throw std::invalid_argument("initial covariance is " + std::to_string(p.rows()) + " x " +
                                std::to_string(p.cols()) + ", expected " + std::to_string(x.size()) +
                                " rows as there are states");
  if (!x.allFinite()) throw std::invalid_argument("initial state has an entry that is not finite");
  s_ = covariance_factor("initial covariance", p);
  if (options_.kind == FilterKind::Unscented) (void)sigma_weights(options_.unscented, x.size());
}

template <class M>
void KalmanFilter<M>::require_finite(const char* where) const {
  // A sum of squares is finite exactly when every term is (or overflows, which is as bad).
  if (!std::isfinite(x_.squaredNorm() + s_.squaredNorm()))
    throw std::runtime_error(std::string("filter: the ") + where + " gave a value that is not finite");
}

template <class M>
template <int Z>
void KalmanFilter<M>::measure_innovation(Innovation<Z>& out, double gate) {
  // log of the product of the diagonal: taken apart before many small or large factors leave the range of
  // doubles.
  double product = 1, log_sum = 0;
  for (Eigen::Index i = 0; i < out.nu.size(); ++i) {
    const double factor = out.factor(i, i);
    if (!(factor > 0) || !std::isfinite(factor))
      throw std::runtime_error("filter: the innovation has no positive definite covariance");
    if (const double next = product * factor; next > 1e-290 && next < 1e290) {
      product = next;
    } else {
      log_sum += std::log(product);
      product = factor;
    }
  }
  out.log_det = 2 * (log_sum + std::log(product));
  out.nis = forward_solved<Z, 1>(out.factor, out.nu).squaredNorm();
  if (!std::isfinite(out.nis)) throw std::runtime_error("filter: a measurement is not finite");
  out.accepted = out.nis <= gate;
}

template <class M>
template <int Size>
Innovation<1> KalmanFilter<M>::correct_by_scalar(const Eigen::Matrix<double, Size, 1>& h, double innovation,
                                                 double sigma, double gate,
                                                 Eigen::Matrix<double, Size, Size>& l,
                                                 Eigen::Matrix<double, Size, 1>& gain) {
  constexpr int kWide = Size == Eigen::Dynamic ? Eigen::Dynamic : Size + 1;
  const Eigen::Matrix<double, Size, 1> a = l.transpose() * h;
  const double variance = a.squaredNorm() + sigma * sigma;
  Innovation<1> out;
  out.nu[0] = innovation;
  out.factor(0, 0) = std::sqrt(variance);
  measure_innovation<1>(out, gate);
  if (!out.accepted) return out;
  gain = l * a / variance;
  Eigen::Matrix<double, Size, kWide> wide(l.rows(), l.cols() + 1);
  wide.template leftCols<Size>(l.cols()) = l - gain * a.transpose();
  wide.col(l.cols()) = gain * sigma;
  l = lower_triangular<Size, kWide>(wide);
  return out;
}

// The measurement says nothing about the state: only (w, Lq) changes.
template <class M>
Innovation<1> KalmanFilter<M>::correct_noise(Noise& w, NoiseFactor& lq, const ProcessMeasurement<kN, kW>& m,
                                             double gate) const {
  Noise gain;
  const Innovation<1> out = correct_by_scalar<kW>(m.hw.transpose(), m.innovation, m.sigma, gate, lq, gain);
  if (out.accepted) w += gain * m.innovation;
  return out;
}

template <class M>
Innovation<1> KalmanFilter<M>::correct_joint(Noise& w, Joint& l, const ProcessMeasurement<kN, kW>& m,
                                             double gate) {
  const Eigen::Index n = x_.size();
  Eigen::Matrix<double, kJoint, 1> h(l.rows()), gain;
  h.template head<kN>(n) = m.hx.transpose();
  h.template segment<kW>(n, w.size()) = m.hw.transpose();
  const Innovation<1> out = correct_by_scalar<kJoint>(h, m.innovation, m.sigma, gate, l, gain);
  if (!out.accepted) return out;
  x_ += gain.template head<kN>(n) * m.innovation;
  w += gain.template segment<kW>(n, w.size()) * m.innovation;
  return out;
}

template <class M>
Innovation<1> KalmanFilter<M>::predict(const Input& u, const NoiseFactor& lq, double dt,
                                       const ProcessMeasurement<kN, kW>* measurement, double gate,
                                       PredictionRecord* record) {
  Innovation<1> out;
  Noise w = Noise::Zero(lq.rows());
  before_ = x_;
  const bool joint_measurement = measurement != nullptr && measurement->touches_state;
  if (options_.kind == FilterKind::Extended && !joint_measurement && record == nullptr) {
    NoiseFactor corrected = lq;
    if (measurement != nullptr) out = correct_noise(w, corrected, *measurement, gate);
    extended_step(u, w, corrected, dt);
  } else {
    const Eigen::Index n = x_.size();
    Joint l = Joint::Zero(n + lq.rows(), n + lq.rows());
    l.template topLeftCorner<kN, kN>(n, n) = s_;
    l.template bottomRightCorner<kW, kW>(lq.rows(), lq.rows()) = lq;
    if (joint_measurement) {
      out = correct_joint(w, l, *measurement, gate);
    } else if (measurement != nullptr) {
      NoiseFactor corrected = lq;
      out = correct_noise(w, corrected, *measurement, gate);
      l.template bottomRightCorner<kW, kW>(lq.rows(), lq.rows()) = corrected;
    }
    if (record != nullptr) record->x = x_;
    if (options_.kind == FilterKind::Extended)
      extended_step(u, w, l, dt, record);
    else
      unscented_step(u, w, l, dt, record);
    if (record != nullptr) record->x_next = x_;
  }
  require_finite("prediction");
  return out;
}

template <class M>
void KalmanFilter<M>::extended_step(const Input& u, const Noise& w, const NoiseFactor& lq, double dt) {
  Square f(x_.size(), x_.size());
  NoiseMap g(x_.size(), w.size());
  const State next = model_.linearise(x_, w, u, dt, f, g);
  Eigen::Matrix<double, kN, kJoint> wide(x_.size(), x_.size() + w.size());
  wide.template leftCols<kN>(x_.size()).noalias() = f * s_;
  wide.template rightCols<kW>(w.size()).noalias() = g * lq;
  x_ = next;
  s_ = lower_triangular<kN, kJoint>(wide);
}

template <class M>
void KalmanFilter<M>::extended_step(const Input& u, const Noise& w, const Joint& l, double dt,
                                    PredictionRecord* record) {
  const Eigen::Index n = x_.size();
  Square f(n, n);
  NoiseMap g(n, w.size());
  const State next = model_.linearise(x_, w, u, dt, f, g);
  const Eigen::Matrix<double, kN, kJoint> wide =
      f * l.template topRows<kN>(n) + g * l.template bottomRows<kW>(w.size());
  x_ = next;
  s_ = lower_triangular<kN, kJoint>(wide);
  if (record == nullptr) return;
  record->before = l.topRows(n);
  record->after = wide;
}

template <class M>
void KalmanFilter<M>::unscented_step(const Input& u, const Noise& w, const Joint& l, double dt,
                                     PredictionRecord* record) {
  const Eigen::Index n = x_.size(), p = w.size(), size = n + p;
  const SigmaWeights q = sigma_weights(options_.unscented, size);
  const double c = std::sqrt(q.spread);
  // Deviations from the moved centre, so that angles never meet their jump.
  Eigen::Matrix<double, kN, kPoints> points(n, 2 * size + 1);
  const State centre = model_.move(x_, w, u, dt);
  State mean = State::Zero(n);
  points.col(0).setZero();
  for (Eigen::Index j = 0; j < size; ++j) {
    const State dx = c * l.col(j).template head<kN>(n);
    const Noise dw = c * l.col(j).template segment<kW>(n, p);
    points.col(1 + j) = model_.move(x_ + dx, w + dw, u, dt) - centre;
    points.col(1 + size + j) = model_.move(x_ - dx, w - dw, u, dt) - centre;
    mean += q.other * (points.col(1 + j) + points.col(1 + size + j));
  }
  const double root = std::sqrt(q.other);
  points.col(0) = -std::sqrt(q.covariance0) * mean;
  for (Eigen::Index j = 1; j <= 2 * size; ++j) points.col(j) = root * (points.col(j) - mean);
  if (record != nullptr) {
    record->before = Matrix::Zero(n, 2 * size + 1);
    record->before.middleCols(1, size) = root * c * l.topRows(n);
    record->before.rightCols(size) = -root * c * l.topRows(n);
    record->after = points;
  }
  x_ = centre + mean;
  s_ = lower_triangular<kN, kPoints>(points);
}

template <class M>
template <class S>
Innovation<S::kSize> KalmanFilter<M>::update(const S& sensor, const Eigen::Matrix<double, S::kSize, 1>& z,
                                             const Eigen::Matrix<double, S::kSize, S::kSize>& lr,
                                             double gate) {
  constexpr int kZ = S::kSize;
  if constexpr (kZ == Eigen::Dynamic) {
    const Eigen::Index size = sensor.measure(x_).size();
    if (z.size() != size || lr.rows() != size || lr.cols() != size)
      throw std::invalid_argument("measurement of " + std::to_string(z.size()) + " values with a factor of " +
                                  std::to_string(lr.rows()) + " x " + std::to_string(lr.cols()) +
                                  ", expected those of the sensor: " + std::to_string(size));
  }
  if (options_.kind == FilterKind::Unscented) return unscented_update(sensor, z, lr, gate);
  Innovation<kZ> out;
  out.nu = z - sensor.measure(options_.literal_47 ? before_ : x_);
  sensor.wrap(out.nu);
  const Eigen::Matrix<double, kZ, kN> a = sensor.jacobian(x_) * s_;
  correct<kZ, kN>(s_, a, lr, gate, out);
  return out;
}

template <class M>
template <class S>
Innovation<S::kSize> KalmanFilter<M>::unscented_update(const S& sensor,
                                                       const Eigen::Matrix<double, S::kSize, 1>& z,
                                                       const Eigen::Matrix<double, S::kSize, S::kSize>& lr,
                                                       double gate) {
  constexpr int kZ = S::kSize;
  constexpr int kCount = kN == Eigen::Dynamic ? Eigen::Dynamic : 2 * kN + 1;
  const Eigen::Index n = x_.size(), m = z.size(), count = 2 * n + 1;
  const SigmaWeights q = sigma_weights(options_.unscented, n);
  const double c = std::sqrt(q.spread), root = std::sqrt(q.other);
  using Value = Eigen::Matrix<double, kZ, 1>;
  const Value centre = sensor.measure(x_);
  Value mean = Value::Zero(m);
  Eigen::Matrix<double, kZ, kCount> dz(m, count);
  Eigen::Matrix<double, kN, kCount> dx(n, count);
  dx.col(0).setZero();
  for (Eigen::Index j = 0; j < n; ++j) {
    const State step = c * s_.col(j);
    Value up = sensor.measure(x_ + step) - centre, down = sensor.measure(x_ - step) - centre;
    sensor.wrap(up);
    sensor.wrap(down);
    mean += q.other * (up + down);
    dz.col(1 + j) = up;
    dz.col(1 + n + j) = down;
    dx.col(1 + j) = root * step;
    dx.col(1 + n + j) = -root * step;
  }
  dz.col(0) = -std::sqrt(q.covariance0) * mean;
  for (Eigen::Index j = 1; j < count; ++j) dz.col(j) = root * (dz.col(j) - mean);
  Innovation<kZ> out;
  out.nu = z - (options_.literal_47 ? sensor.measure(before_) : Value(centre + mean));
  sensor.wrap(out.nu);
  correct<kZ, kCount>(dx, dz, lr, gate, out);
  return out;
}

template <class M>
template <int Z, int C>
void KalmanFilter<M>::correct(const Eigen::Matrix<double, kN, C>& dx, const Eigen::Matrix<double, Z, C>& dz,
                              const Eigen::Matrix<double, Z, Z>& lr, double gate, Innovation<Z>& out) {
  constexpr int kWide = C == Eigen::Dynamic || Z == Eigen::Dynamic ? Eigen::Dynamic : C + Z;
  const Eigen::Index n = dx.rows(), m = dz.rows(), count = dx.cols();
  Eigen::Matrix<double, Z, kWide> innovation(m, count + m);
  innovation.template leftCols<C>(count) = dz;
  innovation.template rightCols<Z>(m) = lr;
  out.factor = lower_triangular<Z, kWide>(innovation);
  measure_innovation<Z>(out, gate);
  if (!out.accepted) return;
  // K' = (Sy Sy')^-1 dz dx'
  const Eigen::Matrix<double, Z, kN> kt =
      backward_solved<Z, kN>(out.factor, forward_solved<Z, kN>(out.factor, dz * dx.transpose()));
  const Eigen::Matrix<double, kN, Z> k = kt.transpose();
  x_ += k * out.nu;
  Eigen::Matrix<double, kN, kWide> wide(n, count + m);
  wide.template leftCols<C>(count) = dx - k * dz;
  wide.template rightCols<Z>(m) = k * lr;
  s_ = lower_triangular<kN, kWide>(wide);
  require_finite("update");
}

}  // namespace odobench
