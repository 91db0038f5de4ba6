#include "problems/entropy/window_problem.hpp"

#include <fmt/format.h>

#include "problems/entropy/direct_form.hpp"

namespace odobench {

WindowProblem::WindowProblem(EntropyWindow window)
    : window_(std::move(window)), quadratic_(ProfileForm(window_.constants).cost(window_)) {
  const int n = window_.constants.samples, size = increment_count(n);
  for (int j = 1; j <= n - 2; ++j)
    for (const char* axis : {"x", "y"})
      parameters_.push_back({fmt::format("delta_a{}({},{})", axis, j + 1, j + 2), "", 0, -1, 1});
  for (int m = 1; m <= n - 1; ++m) parameters_.push_back({fmt::format("eps({},{})", m, m + 1), "", 0, -1, 1});
  levels_.assign(static_cast<std::size_t>(size), Eigen::Vector3d(-1, 0, 1));

  const auto residuals_at = [&](const Vector& t) {
    Vector r(2 * (n - 1) + 9 * n);
    const Vector values = increments(window_.constants, t);
    hamiltonian_residuals(window_, values, closed_form(window_, values), r);
    return r;
  };
  residuals_at_zero_ = residuals_at(Vector::Zero(size));
  jacobian_.resize(residuals_at_zero_.size(), size);
  for (int i = 0; i < size; ++i) jacobian_.col(i) = residuals_at(Vector::Unit(size, i)) - residuals_at_zero_;
}

void WindowProblem::normal_equations(const ConstVectorRef& x, NormalEquations& out) const {
  out.jtr.resize(x.size());
  out.cost = quadratic_.cost_and_gradient(x, out.jtr);
  out.jtr *= 0.5;
  out.jtj = Matrix::Zero(x.size(), x.size());
  for (const QuadraticBlock& block : quadratic_.blocks) out.jtj(block.index, block.index) = block.q;
}

EntropyState WindowProblem::state(const ConstVectorRef& t) const {
  return closed_form(window_, increments(window_.constants, t));
}

}  // namespace odobench
