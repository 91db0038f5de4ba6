// A discretised linear system and linear sensors as models of KalmanFilter: with the extended kind, the linear Kalman
// filter for any number of states.
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <vector>

#include "problems/fusion/kalman_filter.hpp"
#include "problems/fusion/linear_system.hpp"

namespace odobench {

// x' = F x + Psi u + w. The period is in F and Psi; dt is not looked at.
struct LinearModel {
  static constexpr int kStates = Eigen::Dynamic, kNoises = Eigen::Dynamic;
  using Input = Vector;
  Matrix f, psi;

  Vector move(const Vector& x, const Vector& w, const Vector& u, double) const {
    Vector next = f * x + w;
    if (u.size() > 0) next += psi * u;
    return next;
  }
  void linearise(const Vector& x, const Vector&, const Vector&, double, Matrix& df, Matrix& dg) const {
    df = f;
    dg = Matrix::Identity(x.size(), x.size());
  }
};

// z = H x; `angles` lists the components whose differences are wrapped.
struct LinearSensor {
  static constexpr int kSize = Eigen::Dynamic;
  Matrix h;
  std::vector<Eigen::Index> angles;

  Vector measure(const Vector& x) const {
    if (x.size() != h.cols())
      throw std::invalid_argument(
          fmt::format("sensor: H has {} columns, expected {} as there are states", h.cols(), x.size()));
    return h * x;
  }
  Matrix jacobian(const Vector&) const { return h; }
  void wrap(Vector& difference) const {
    for (const Eigen::Index i : angles) difference[i] = wrapped_angle(difference[i]);
  }
};

using LinearKalmanFilter = KalmanFilter<LinearModel>;

}  // namespace odobench
