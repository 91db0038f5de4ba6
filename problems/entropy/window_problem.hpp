// One window of the relative-entropy filter on the shared cost interface: J(t) = -H(t), t in [-1, 1]^(3N-5).
// On the lattice {-1, 0, 1}^(3N-5) that is the thesis' problem; between its points it is the smooth
// relaxation, a lower bound.
#pragma once

#include "problems/entropy/profile_form.hpp"
#include "problems/problem.hpp"

namespace odobench {

class WindowProblem {
 public:
  // Throws std::invalid_argument when the window is not valid.
  explicit WindowProblem(EntropyWindow window);

  std::string name() const { return "entropy"; }
  const std::vector<ParameterInfo>& parameters() const { return parameters_; }
  double cost(const ConstVectorRef& x) const { return quadratic_.cost(x); }
  double cost_and_gradient(const ConstVectorRef& x, VectorRef g) const {
    return quadratic_.cost_and_gradient(x, g);
  }
  // The residuals of (2.29) at the closed form of the continuous unknowns: affine in t.
  Eigen::Index residual_count() const { return residuals_at_zero_.size(); }
  void residuals(const ConstVectorRef& x, VectorRef r) const { r = residuals_at_zero_ + jacobian_ * x; }
  void residuals_and_jacobian(const ConstVectorRef& x, VectorRef r, MatrixRef j) const {
    residuals(x, r);
    j = jacobian_;
  }
  void normal_equations(const ConstVectorRef& x, NormalEquations& out) const;

  const std::vector<Vector>& lattice_levels() const { return levels_; }
  std::unique_ptr<LatticePoint> lattice_point(const ConstVectorRef& x) const {
    return block_quadratic_point(quadratic_, x);
  }
  const BlockQuadratic& block_quadratic() const { return quadratic_; }

  const EntropyWindow& window() const { return window_; }
  // r1, sx1, sy1, ax12, ay12 at t.
  EntropyState state(const ConstVectorRef& t) const;

 private:
  EntropyWindow window_;
  BlockQuadratic quadratic_;
  std::vector<ParameterInfo> parameters_;
  std::vector<Vector> levels_;
  Vector residuals_at_zero_;
  Matrix jacobian_;
};

}  // namespace odobench
