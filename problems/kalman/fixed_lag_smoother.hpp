// A linear Kalman filter whose estimates are corrected by the measurements of the next few steps, in constant
// memory:
//     x(k+1) = F x(k) + G w(k),  w white with factor Lq;     z(k) = H x(k) + noise of factor Lr.
// The filter is KalmanFilter on that model. Going back uses H. Rauch, F. Tung, C. Striebel (AIAA Journal
// 3(8), 1965):
//     x_s(k) = x(k) + C(k) (x_s(k+1) - F x(k)),   C(k) = P(k) F' P(k+1|k)^-1.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <stdexcept>
#include <vector>

#include "problems/kalman/kalman_filter.hpp"

namespace odobench {

template <int N, int W>
struct ConstantModel {
  static constexpr int kStates = N, kNoises = W;
  struct Input {};
  using State = Eigen::Matrix<double, N, 1>;
  Eigen::Matrix<double, N, N> f;
  Eigen::Matrix<double, N, W> g;

  State move(const State& x, const Eigen::Matrix<double, W, 1>& w, const Input&, double) const {
    return f * x + g * w;
  }
  State linearise(const State& x, const Eigen::Matrix<double, W, 1>& w, const Input& u, double dt,
                  Eigen::Matrix<double, N, N>& df, Eigen::Matrix<double, N, W>& dg) const {
    df = f;
    dg = g;
    return move(x, w, u, dt);
  }
};

// The first Z components of the state.
template <int N, int Z>
struct LeadingSensor {
  static constexpr int kSize = Z;
  Eigen::Matrix<double, Z, 1> measure(const Eigen::Matrix<double, N, 1>& x) const {
    return x.template head<Z>();
  }
  Eigen::Matrix<double, Z, N> jacobian(const Eigen::Matrix<double, N, 1>&) const {
    return Eigen::Matrix<double, Z, N>::Identity();
  }
  void wrap(Eigen::Matrix<double, Z, 1>&) const {}
};

template <int N, int W>
class FixedLagSmoother {
 public:
  using Model = ConstantModel<N, W>;
  using State = Eigen::Matrix<double, N, 1>;
  using Square = Eigen::Matrix<double, N, N>;

  // The estimate after the first measurements is x with covariance p, positive definite. `noise` factors the
  // covariance of w. Throws std::invalid_argument as KalmanFilter does, and on a negative lag.
  FixedLagSmoother(const Model& model, const Eigen::Matrix<double, W, W>& noise, int lag, const State& x,
                   const Square& p)
      : filter_(model, KalmanOptions{}, x, p), noise_(noise), steps_(checked(lag)) {}

  void predict() {
    Step& step = steps_[next_];
    next_ = (next_ + 1) % steps_.size();
    kept_ = std::min(kept_ + 1, steps_.size());
    step.x = filter_.state();
    const Square moved = filter_.model().f * filter_.covariance();  // F P
    filter_.predict({}, noise_, 0);
    step.next = filter_.state();
    const Square& s = filter_.factor();
    step.gain = backward_solved<N, N>(s, forward_solved<N, N>(s, moved)).transpose();
  }

  // z: the first Z components of the state, with independent errors of these deviations.
  template <int Z>
  double update(const Eigen::Matrix<double, Z, 1>& z, const Eigen::Matrix<double, Z, 1>& sigma) {
    return filter_
        .update(LeadingSensor<N, Z>{}, z, Eigen::Matrix<double, Z, Z>(sigma.asDiagonal().toDenseMatrix()))
        .nis;
  }

  const State& filtered() const { return filter_.state(); }
  // Of the instant `lag` steps back, or the first there was.
  State smoothed() const {
    State x = filter_.state();
    for (std::size_t back = 1; back <= kept_; ++back) {
      const Step& step = steps_[(next_ + steps_.size() - back) % steps_.size()];
      x = step.x + step.gain * (x - step.next);
    }
    return x;
  }

 private:
  struct Step {
    State x, next;  // before the step; predicted for after it
    Square gain;
  };
  static std::size_t checked(int lag) {
    if (lag < 1) throw std::invalid_argument("smoother: lag " + std::to_string(lag) + ", expected 1 or more");
    return static_cast<std::size_t>(lag);
  }

  KalmanFilter<Model> filter_;
  Eigen::Matrix<double, W, W> noise_;
  std::vector<Step> steps_;
  std::size_t next_ = 0, kept_ = 0;
};

}  // namespace odobench
