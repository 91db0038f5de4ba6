// A quick problem with the difficulties of the real calibration and a known optimum: curvatures as the
// squares of the real Jacobian's singular values (condition 2.3e9) in a fixed rotation, and six of twelve
// bounds active with multipliers from 3 to 300.
//     J(x) = 98.1 + (x - x*)'H(x - x*) + g'(x - x*),   g_i x*_i < 0 where |x*_i| = 1, g_i = 0 elsewhere
// Convex, and by the Karush-Kuhn-Tucker conditions J(x*) = 98.1 is the lowest cost in the box [-1, 1]^12.
#pragma once

#include <Eigen/QR>
#include <cmath>
#include <string>
#include <vector>

#include "problems/problem.hpp"

namespace odobench::testing {

class ValleyProblem {
 public:
  static constexpr double kOptimum = 98.1;
  ValleyProblem() {
    constexpr Eigen::Index n = 12;
    for (Eigen::Index i = 0; i < n; ++i) list_.push_back({"x" + std::to_string(i + 1), "1", 0, -1, 1});
    Matrix seed(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j)
        seed(i, j) = std::sin(static_cast<double>(2 + 5 * i + 11 * j + i * j));
    const Matrix q = Eigen::HouseholderQR<Matrix>(seed).householderQ();
    Vector d(n);
    d << 2903, 2524, 758, 166, 15.4, 14.7, 1.56, 1.22, 0.54, 0.37, 0.29, 0.06;
    root_ = 0.05 * d.asDiagonal() * q;
    optimum_ = Vector::LinSpaced(n, -0.7, 0.8);
    slope_ = Vector::Zero(n);
    for (Eigen::Index i = 0; i < n; i += 2) {
      optimum_[i] = i % 4 == 0 ? 1.0 : -1.0;
      slope_[i] = -optimum_[i] * 3.0 * std::pow(10.0, 0.2 * static_cast<double>(i));
    }
  }
  std::string name() const { return "valley"; }
  const std::vector<ParameterInfo>& parameters() const { return list_; }
  double cost(const ConstVectorRef& x) const {
    const Vector d = x - optimum_;
    return kOptimum + (root_ * d).squaredNorm() + slope_.dot(d);
  }
  double known_optimum() const { return kOptimum; }

 private:
  std::vector<ParameterInfo> list_;
  Matrix root_;
  Vector optimum_, slope_;
};

}  // namespace odobench::testing
