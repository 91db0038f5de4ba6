// A discretised linear system and linear sensors as models of KalmanFilter: with the extended kind, the
// linear Kalman filter for any number of states.
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <vector>

#include "problems/kalman/kalman_filter.hpp"
#include "problems/kalman/linear_system.hpp"

namespace odobench {

// x' = F x + Psi u + w. The period is in F and Psi; dt is not looked at.
struct LinearSystemModel {
  static constexpr int kStates = Eigen::Dynamic, kNoises = Eigen::Dynamic;
  using Input = Vector;
  Matrix f, psi;

  // Throws std::invalid_argument when a size does not fit.
  Vector move(const Vector& x, const Vector& w, const Vector& u, double) const {
    if (f.rows() != x.size() || f.cols() != x.size() || w.size() != x.size() || u.size() != psi.cols() ||
        (u.size() > 0 && psi.rows() != x.size()))
      throw std::invalid_argument(fmt::format(
          "linear model: F {} x {}, Psi {} x {}, {} states, noise of {}, {} inputs do not fit together",
          f.rows(), f.cols(), psi.rows(), psi.cols(), x.size(), w.size(), u.size()));
    Vector next = f * x + w;
    if (u.size() > 0) next += psi * u;
    return next;
  }
  Vector linearise(const Vector& x, const Vector& w, const Vector& u, double dt, Matrix& df,
                   Matrix& dg) const {
    df = f;
    dg = Matrix::Identity(x.size(), x.size());
    return move(x, w, u, dt);
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

using LinearKalmanFilter = KalmanFilter<LinearSystemModel>;

}  // namespace odobench
