#include "solvers/local/local_model.hpp"

#include <Eigen/QR>
#include <cmath>
#include <limits>

#include "solvers/box/box_least_squares.hpp"
#include "solvers/box/box_quadratic.hpp"
#include "solvers/certificate/optimality.hpp"
#include "solvers/certificate/rounding.hpp"

namespace odobench {
namespace {

// With more parameters the factorisations cost too much.
constexpr Eigen::Index kMostFactored = 200;

}  // namespace

LocalModel::LocalModel(const Problem& problem, StepScale scale)
    : factored_(problem.forms_normal_equations() && problem.dimension() <= kMostFactored), scale_(scale) {}

bool LocalModel::evaluate(Run& run, const Vector& u) {
  return factored_ ? evaluate_residuals(run, u) : evaluate_normal_equations(run, u);
}

// `squares`: |J_i|^2 / |r|^2 at the present point, whose |r|^2 is `cost`. What was met before is kept in the
// same unit, so that no square root comes between the cost's scale and the step.
void LocalModel::remember(const Vector& squares, double cost) {
  damping_ = damping_.size() == 0 ? squares : (damping_ * (cost_ / cost)).cwiseMax(squares);
  if (scale_ == StepScale::Box) damping_.setConstant(damping_.maxCoeff());
  length_ = squares.cwiseSqrt();
  cost_ = cost;
}

bool LocalModel::evaluate_normal_equations(Run& run, const Vector& u) {
  NormalEquations e;
  if (!std::isfinite(run.normal_equations(u, e))) return false;
  gradient_ = e.jtr / e.cost;
  curvature_ = e.jtj / e.cost;
  remember(curvature_.diagonal().cwiseMax(0.0), e.cost);
  return true;
}

bool LocalModel::evaluate_residuals(Run& run, const Vector& u) {
  Vector r(run.problem().residual_count());
  Matrix j(r.size(), u.size());
  const double cost = run.residuals_and_jacobian(u, r, j);
  if (!std::isfinite(cost)) return false;
  const double norm = r.stableNorm();
  j /= norm;
  r /= norm;
  Vector squares(u.size());
  for (Eigen::Index i = 0; i < u.size(); ++i) squares[i] = j.col(i).squaredNorm();
  remember(squares, cost);
  gradient_ = j.transpose() * r;
  if (j.rows() <= j.cols()) {
    factor_ = std::move(j);
    rotated_ = std::move(r);
    return true;
  }
  const Eigen::HouseholderQR<Matrix> qr(std::move(j));
  factor_ = qr.matrixQR().topRows(u.size()).triangularView<Eigen::Upper>();
  rotated_ = (qr.householderQ().adjoint() * r).head(u.size());
  return true;
}

double LocalModel::projected_cosine(const Vector& u) const {
  double largest = 0;
  for (Eigen::Index i = 0; i < u.size(); ++i)
    if (length_[i] > 0 && !held_by_bound(u[i], gradient_[i]))
      largest = std::max(largest, std::abs(gradient_[i]) / length_[i]);
  return largest;
}

Vector LocalModel::step(double lambda, const Vector& lower, const Vector& upper) const {
  const Eigen::Index m = gradient_.size();
  if (factored_) {
    if (lambda == 0) return solve_box_least_squares(factor_, rotated_, lower, upper);
    Matrix a(factor_.rows() + m, m);
    a << factor_, Matrix((lambda * damping_).cwiseSqrt().asDiagonal());
    Vector b(factor_.rows() + m);
    b << rotated_, Vector::Zero(m);
    return solve_box_least_squares(a, b, lower, upper);
  }
  // A trace of damping keeps the model definite.
  Vector damping = std::max(lambda, 1e-15) * damping_;
  damping = damping.cwiseMax(1e-16 * std::max(damping.maxCoeff(), std::numeric_limits<double>::min()));
  Matrix h = curvature_;
  h.diagonal() += damping;
  return solve_box_quadratic(h, gradient_, lower, upper);
}

double LocalModel::decrease(const Vector& d) const {
  if (!factored_) return -(2.0 * gradient_.dot(d) + d.dot(curvature_ * d));
  const Vector change = factor_ * d;
  return -(2.0 * rotated_.dot(change) + change.squaredNorm());
}

double LocalModel::rounding_part(const Run& run, const Vector& u) const {
  return resolution_part_of_cost(run.box(), u, length_);
}

}  // namespace odobench
