#include "solvers/certificate/verdict.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/range.hpp"
#include "solvers/box/box.hpp"
#include "solvers/box/box_active_set.hpp"
#include "solvers/box/box_quadratic.hpp"
#include "solvers/box/linear_model.hpp"
#include "solvers/certificate/derivative_check.hpp"
#include "solvers/certificate/optimality.hpp"
#include "solvers/certificate/rounding.hpp"

namespace odobench {
namespace {

// Entries of a Jacobian that may be formed to see what the problem's own normal equations cannot resolve.
constexpr Eigen::Index kMostEntries = 50'000'000;
// Below this the squares of residuals have lost digits to underflow.
constexpr double kSmallestSquare = 1e-290;

Vector room_below(const Vector& u) {
  return -(u.array() + 1.0).matrix();
}
Vector room_above(const Vector& u) {
  return (1.0 - u.array()).matrix();
}

void judge(OptimalityCheck& check, const Problem& problem, const ConstVectorRef& x, const Box& box,
           const LinearModel& model) {
  const Vector u = box.to_unit(x);
  check.value = promised_gain(model, room_below(u), room_above(u));
  check.limit =
      std::max(kPromiseLimit, std::min(1.0, rounding_part_of_cost(problem, box, u, model.size, model.cost)));
}

// By residuals and Jacobian. An exact fit promises nothing.
void check_residuals(OptimalityCheck& check, const Problem& problem, const ConstVectorRef& x,
                     const Box& box) {
  Vector r(problem.residual_count());
  Matrix j(problem.residual_count(), problem.dimension());
  problem.residuals_and_jacobian(x, r, j);
  if (!r.allFinite() || !j.allFinite()) return;
  if (r.cwiseAbs().maxCoeff() == 0)
    check.value = 0;
  else
    judge(check, problem, x, box, linear_model(r, box.jacobian_to_unit(j)));
}

void check_normal_equations(OptimalityCheck& check, const Problem& problem, const ConstVectorRef& x,
                            const Box& box) {
  NormalEquations e;
  problem.normal_equations(x, e);
  if (!std::isfinite(e.cost) || !e.jtr.allFinite() || !e.jtj.allFinite()) return;
  const bool small = problem.has_residuals() && problem.residual_count() * problem.dimension() < kMostEntries;
  if (e.cost < kSmallestSquare && small) return check_residuals(check, problem, x, box);
  if (e.cost == 0) {
    check.value = 0;
    return;
  }
  const LinearModel model = linear_model(box.to_unit(e));
  if (model.truncated && small) return check_residuals(check, problem, x, box);
  judge(check, problem, x, box, model);
}

// Half the matrix of second derivatives in unit coordinates, by differences of gradients towards the middle
// of the box. Empty where one of them is not finite.
Matrix curvature(const Problem& problem, const Box& box, const Vector& u, const Vector& g) {
  constexpr double kProbe = 1e-6;
  Matrix h(u.size(), u.size());
  Vector full(problem.dimension());
  for (Eigen::Index i = 0; i < u.size(); ++i) {
    Vector moved = u;
    moved[i] += u[i] > 0 ? -kProbe : kProbe;
    problem.cost_and_gradient(box.to_parameters(moved), full);
    h.col(i) = (box.gradient_to_unit(full) - g) / (moved[i] - u[i]);
  }
  if (!h.allFinite()) return {};
  return 0.5 * (h + h.transpose());
}

// What the quadratic model gains inside the box: by its minimum, or where it curves downwards along a free
// direction, by going there as far as the box allows.
double newton_gain(const Matrix& h, const Vector& g, const Vector& u) {
  const Vector lower = room_below(u), upper = room_above(u);
  Indices free;
  for (Eigen::Index i = 0; i < u.size(); ++i)
    if (!held_by_bound(u[i], g[i])) free.push_back(i);
  if (free.empty()) return 0;
  const Matrix part = h(free, free);
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(part);
  const double largest =
      std::max(eigen.eigenvalues().cwiseAbs().maxCoeff(), std::numeric_limits<double>::min());
  if (const double lowest = eigen.eigenvalues()[0]; lowest < -1e-6 * largest) {
    Vector d = Vector::Zero(u.size());
    d(free) = eigen.eigenvectors().col(0);
    if (g.dot(d) > 0) d = -d;
    double length = std::numeric_limits<double>::infinity();
    for (const Eigen::Index i : free)
      if (d[i] != 0) length = std::min(length, (d[i] < 0 ? lower[i] : upper[i]) / d[i]);
    return -length * (g.dot(d) + 0.5 * length * lowest);
  }
  // A trace of damping keeps what is flat definite.
  Matrix model = part;
  model.diagonal().array() += std::max(1e-15 * largest, -2 * std::min(eigen.eigenvalues()[0], 0.0));
  const Vector slope = g(free);
  const Vector d = solve_box_quadratic(model, slope, lower(free), upper(free));
  return -(slope.dot(d) + 0.5 * d.dot(part * d));
}

void check_gradient(OptimalityCheck& check, const Problem& problem, const ConstVectorRef& x, const Box& box) {
  const Vector u = box.to_unit(x);
  Vector full(problem.dimension());
  const double cost = problem.cost_and_gradient(x, full);
  if (!std::isfinite(cost) || !full.allFinite()) return;
  const Vector g = box.gradient_to_unit(full);
  const Matrix h = curvature(problem, box, u, g);
  if (h.size() == 0) return;
  const Vector resolution = 2.0 * box.resolution(u);
  const double rounding =
      g.cwiseAbs().dot(resolution) + 0.5 * h.diagonal().cwiseAbs().dot(resolution.cwiseAbs2());
  const double floor = std::max(problem.rounding_floor(x), rounding);
  const double gain = std::max(0.0, newton_gain(h, g, u));
  const double unit = std::max({std::abs(cost), floor, std::numeric_limits<double>::min()});
  check.value = gain / unit;
  check.limit = std::max(kPromiseLimit, floor / unit);
}

}  // namespace

std::string OptimalityCheck::text() const {
  if (std::isnan(value)) return fmt::format("{}: cost or derivatives are not finite there", test);
  return fmt::format("{} promises {:.2g} {} {:.2g} of the cost{}", test, value, holds() ? "<=" : ">", limit,
                     limit > kPromiseLimit ? ", which rounding explains" : "");
}

std::optional<OptimalityCheck> check_optimality(const Problem& problem, const ConstVectorRef& x) {
  const Problem own = problem;  // a copy has evaluation counts of its own
  const Box box(own.parameters());
  OptimalityCheck check;
  check.limit = kPromiseLimit;
  if (box.dimension() == 0) {
    check.test = "no free parameter";
    return check;
  }
  check.value = kNotANumber;
  if (own.has_normal_equations()) {
    check.test = "a bounded Gauss-Newton step";
    if (own.forms_normal_equations())
      check_residuals(check, own, x, box);
    else
      check_normal_equations(check, own, x, box);
  } else if (own.has_gradient()) {
    check.test = "a bounded Newton step";
    check_gradient(check, own, x, box);
  } else {
    return std::nullopt;
  }
  check.evaluations = own.counts().total();
  return check;
}

std::optional<double> promise_by_differences(const Problem& problem, const ConstVectorRef& x) {
  const Problem own = problem;
  const Box box(own.parameters());
  const Matrix j = difference_jacobian(own, x);
  if (j.size() == 0 || box.dimension() == 0) return std::nullopt;
  Vector r(own.residual_count());
  own.residuals(x, r);
  if (r.cwiseAbs().maxCoeff() == 0) return 0;
  const Vector u = box.to_unit(x);
  return promised_gain(linear_model(r, box.jacobian_to_unit(j)), room_below(u), room_above(u));
}

double bounded_promise(const Vector& u, const NormalEquations& e) {
  if (e.cost == 0) return 0;
  return promised_gain(linear_model(e), room_below(u), room_above(u));
}

}  // namespace odobench
