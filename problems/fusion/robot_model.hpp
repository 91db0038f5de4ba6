// A robot in the plane, driven by the body twist that its wheels report, and its sensors: models for
// KalmanFilter.
//
// State: pose (x, y [m], theta [rad, not wrapped]), then, where chosen, the gyro's bias b [rad/s], the scale
// error s of the odometry's translation, and a copy of the pose at an earlier instant (for relative
// measurements). Noise w: of the twist (m/s, m/s, rad/s), then the random walks of b and s.
//     x'     = x + dt (cos(theta) u_x - sin(theta) u_y),      u_x = (1 + s) vx + w_1
//     y'     = y + dt (sin(theta) u_x + cos(theta) u_y),      u_y = (1 + s) vy + w_2      explicit Euler, as
//     (3.2) of
//     theta' = theta + dt (omega + w_3)                                                   J. Vitko's thesis
//     (2024)
//     b' = b + w_b,  s' = s + w_s
// so F = [1 0 -dt vy_world; 0 1 dt vx_world; 0 0 1] and G = dt diag(R(theta), 1) for the pose (4.3)-(4.4).
#pragma once

#include <cmath>

#include "base/pose.hpp"
#include "datasets/recording.hpp"
#include "problems/kalman/kalman_filter.hpp"

namespace odobench {

// (2.16)-(2.17) of the thesis in the body frame for the parameters z = (a1..a4, b1..b4, r1..r4), sample k.
Twist wheel_twist(const Recording& recording, std::size_t k, const ConstVectorRef& z);

template <bool HasBias, bool HasScale, bool HasCopy>
struct RobotModel {
  static constexpr int kBias = 3;
  static constexpr int kScale = 3 + (HasBias ? 1 : 0);
  static constexpr int kCopy = kScale + (HasScale ? 1 : 0);
  static constexpr int kStates = kCopy + (HasCopy ? 3 : 0);
  static constexpr int kNoises = kCopy;
  static constexpr bool kHasBias = HasBias, kHasScale = HasScale, kHasCopy = HasCopy;
  using Input = Twist;
  using State = Eigen::Matrix<double, kStates, 1>;
  using Noise = Eigen::Matrix<double, kNoises, 1>;

  State move(const State& x, const Noise& w, const Twist& u, double dt) const {
    const double c = std::cos(x[2]), s = std::sin(x[2]);
    const double vx = scale(x) * u.vx + w[0], vy = scale(x) * u.vy + w[1];
    State next = x;
    next[0] += dt * (c * vx - s * vy);
    next[1] += dt * (s * vx + c * vy);
    next[2] += dt * (u.omega + w[2]);
    if constexpr (HasBias) next[kBias] += w[kBias];
    if constexpr (HasScale) next[kScale] += w[kScale];
    return next;
  }

  // The derivatives, and what move() gives.
  State linearise(const State& x, const Noise& w, const Twist& u, double dt,
                  Eigen::Matrix<double, kStates, kStates>& f,
                  Eigen::Matrix<double, kStates, kNoises>& g) const {
    const double c = std::cos(x[2]), s = std::sin(x[2]);
    const double vx = scale(x) * u.vx + w[0], vy = scale(x) * u.vy + w[1];
    f.setIdentity();
    f(0, 2) = -dt * (s * vx + c * vy);
    f(1, 2) = dt * (c * vx - s * vy);
    g.setZero();
    g(0, 0) = g(1, 1) = dt * c;
    g(0, 1) = -dt * s;
    g(1, 0) = dt * s;
    g(2, 2) = dt;
    if constexpr (HasBias) g(kBias, kBias) = 1;
    if constexpr (HasScale) {
      g(kScale, kScale) = 1;
      f(0, kScale) = dt * (c * u.vx - s * u.vy);
      f(1, kScale) = dt * (s * u.vx + c * u.vy);
    }
    State next = x;
    next[0] += f(1, 2);
    next[1] -= f(0, 2);
    next[2] += dt * (u.omega + w[2]);
    if constexpr (HasBias) next[kBias] += w[kBias];
    if constexpr (HasScale) next[kScale] += w[kScale];
    return next;
  }

  // A gyro that reads omega + b + noise while the wheels say `omega`.
  ProcessMeasurement<kStates, kNoises> yaw_rate(const State& x, double omega, double reading,
                                                double sigma) const {
    ProcessMeasurement<kStates, kNoises> m;
    m.hx.setZero();
    m.hw.setZero();
    m.hw[2] = 1;
    m.sigma = sigma;
    m.innovation = reading - omega;
    if constexpr (HasBias) {
      m.hx[kBias] = 1;
      m.innovation -= x[kBias];
      m.touches_state = true;
    }
    return m;
  }

  // The map that writes the pose into its copy.
  static Eigen::Matrix<double, kStates, kStates> copy_map() {
    Eigen::Matrix<double, kStates, kStates> t = Eigen::Matrix<double, kStates, kStates>::Identity();
    if constexpr (HasCopy) {
      t.template bottomRows<3>().setZero();
      t.template block<3, 3>(kCopy, 0).setIdentity();
    }
    return t;
  }

 private:
  static double scale([[maybe_unused]] const State& x) {
    if constexpr (HasScale)
      return 1 + x[kScale];
    else
      return 1;
  }
};

// z = (x, y, theta), theta of any turn.
template <int N>
struct PoseSensor {
  static constexpr int kSize = 3;
  using State = Eigen::Matrix<double, N, 1>;
  Eigen::Vector3d measure(const State& x) const { return x.template head<3>(); }
  Eigen::Matrix<double, 3, N> jacobian(const State&) const { return Eigen::Matrix<double, 3, N>::Identity(); }
  void wrap(Eigen::Vector3d& d) const { d[2] = wrapped_angle(d[2]); }
};

// z = (theta).
template <int N>
struct HeadingSensor {
  static constexpr int kSize = 1;
  using State = Eigen::Matrix<double, N, 1>;
  using Value = Eigen::Matrix<double, 1, 1>;
  Value measure(const State& x) const { return Value(x[2]); }
  Eigen::Matrix<double, 1, N> jacobian(const State&) const {
    Eigen::Matrix<double, 1, N> h = Eigen::Matrix<double, 1, N>::Zero();
    h[2] = 1;
    return h;
  }
  void wrap(Value& d) const { d[0] = wrapped_angle(d[0]); }
};

// The pose seen from its copy: R(theta_c)'(p - p_c), theta - theta_c. Drift that was there already at the
// copy's instant does not enter.
template <int N, int Copy>
struct RelativePoseSensor {
  static constexpr int kSize = 3;
  using State = Eigen::Matrix<double, N, 1>;
  Eigen::Vector3d measure(const State& x) const {
    const double c = std::cos(x[Copy + 2]), s = std::sin(x[Copy + 2]);
    const double dx = x[0] - x[Copy], dy = x[1] - x[Copy + 1];
    return {c * dx + s * dy, c * dy - s * dx, x[2] - x[Copy + 2]};
  }
  Eigen::Matrix<double, 3, N> jacobian(const State& x) const {
    const double c = std::cos(x[Copy + 2]), s = std::sin(x[Copy + 2]);
    const Eigen::Vector3d z = measure(x);
    Eigen::Matrix<double, 3, N> h = Eigen::Matrix<double, 3, N>::Zero();
    h(0, 0) = h(1, 1) = c;
    h(0, 1) = s;
    h(1, 0) = -s;
    h(2, 2) = 1;
    h.template block<3, 2>(0, Copy) = -h.template leftCols<2>();
    h(0, Copy + 2) = z[1];
    h(1, Copy + 2) = -z[0];
    h(2, Copy + 2) = -1;
    return h;
  }
  void wrap(Eigen::Vector3d& d) const { d[2] = wrapped_angle(d[2]); }
};

}  // namespace odobench
