// A function of More, Garbow and Hillstrom as a problem: from its own starts (more_garbow_hillstrom.hpp), or
// in the cases that More and Wild chose (problems/suites/more_wild.hpp).
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "problems/classic/mgh_functions.hpp"

namespace odobench {

// J = sum of r_i(x)^2, with residuals and their Jacobian.
class MghProblem {
 public:
  // `optimum` and `residual_count` of the function with the length of `start`. Parameters x1, x2, ..; bounds
  // at +-10 times the largest of 1, |start| and what is known of the minimisers.
  MghProblem(std::string name, const MghFunction& function, MghOptimum optimum, int residual_count,
             const Vector& start)
      : name_(std::move(name)),
        evaluate_(function.evaluate),
        residual_count_(residual_count),
        optimum_(std::move(optimum)) {
    for (Eigen::Index i = 0; i < start.size(); ++i) {
      double most = std::max(1.0, std::abs(start[i]));
      for (const Vector& x : optimum_.minimisers) most = std::max(most, std::abs(x[i]));
      parameters_.push_back({fmt::format("x{}", i + 1), "1", start[i], -10 * most, 10 * most});
    }
  }
  std::string name() const { return name_; }
  const std::vector<ParameterInfo>& parameters() const { return parameters_; }
  std::optional<double> known_optimum() const { return optimum_.cost; }
  const std::vector<Vector>& known_minimisers() const { return optimum_.minimisers; }
  Eigen::Index residual_count() const { return residual_count_; }

  double cost(const ConstVectorRef& x) const {
    Vector r(residual_count_);
    residuals(x, r);
    return r.squaredNorm();
  }
  void residuals(const ConstVectorRef& x, VectorRef r) const { evaluate_(x, r, nullptr); }
  void residuals_and_jacobian(const ConstVectorRef& x, VectorRef r, MatrixRef j) const {
    j.setZero();
    evaluate_(x, r, &j);
  }

 private:
  std::string name_;
  decltype(MghFunction::evaluate) evaluate_;
  Eigen::Index residual_count_;
  MghOptimum optimum_;
  std::vector<ParameterInfo> parameters_;
};

}  // namespace odobench
