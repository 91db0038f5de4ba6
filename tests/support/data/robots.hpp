// Random signals and parameters of wheeled robots, and their derivatives by differences.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "problems/robots/wheeled_robot.hpp"

namespace odobench::testing {

// Drives up to 5 rad/s, steering up to `steering` rad.
inline Matrix random_signals(const robots::WheeledRobot& robot, Eigen::Index samples, std::mt19937& random,
                             double steering = 1.2) {
  std::uniform_real_distribution<double> unit(-1, 1);
  Matrix s(static_cast<Eigen::Index>(robot.signals().size()), samples);
  for (Eigen::Index k = 0; k < samples; ++k)
    for (Eigen::Index i = 0; i < s.rows(); ++i)
      s(i, k) = unit(random) * (i < robot.drive_count() ? 5 : steering);
  return s;
}

// Inside the box.
inline Vector random_parameters(const robots::WheeledRobot& robot, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  Vector z = robot.nominal();
  for (std::size_t i = 0; i < robot.parameters().size(); ++i) {
    const RobotParameter& p = robot.parameters()[i];
    z[static_cast<Eigen::Index>(i)] = p.lower + (p.upper - p.lower) * unit(random);
  }
  return z;
}

inline Matrix twists_of(const robots::WheeledRobot& robot, const Matrix& signals, const Vector& z,
                        const Matrix* rates = nullptr) {
  Matrix t(3, signals.cols());
  robot.twists(signals, z, t, rates);
  return t;
}

// Columns: derivatives of a vector by the five-point formula; its error is about 1e-11 of the size of the
// values here.
inline Matrix differences(const std::function<Vector(const Vector&)>& f, const Vector& z,
                          double step = 1e-3) {
  Matrix d(f(z).size(), z.size());
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const double h = step * std::max(0.1, std::abs(z[i]));
    const auto at = [&](double steps) {
      Vector y = z;
      y[i] += steps * h;
      return f(y);
    };
    d.col(i) = (at(-2) - at(2) + 8 * (at(1) - at(-1))) / (12 * h);
  }
  return d;
}

inline Vector flat(const Matrix& m) {
  return m.reshaped();
}

}  // namespace odobench::testing
