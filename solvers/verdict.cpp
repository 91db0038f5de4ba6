#include "solvers/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "solvers/box.hpp"
#include "solvers/linear_model.hpp"
#include "solvers/rounding.hpp"

namespace odobench {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
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
  check.limit = std::max(kPromiseLimit, rounding_part_of_cost(problem, box, u, model.size, model.cost));
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

void check_gradient(OptimalityCheck& check, const Problem& problem, const ConstVectorRef& x, const Box& box) {
  const Vector u = box.to_unit(x);
  Vector full(problem.dimension());
  const double cost = problem.cost_and_gradient(x, full);
  if (!std::isfinite(cost) || !full.allFinite()) return;
  const Vector g = box.gradient_to_unit(full);
  const double size = std::abs(cost), steepest = g.cwiseAbs().maxCoeff();
  const double own = problem.rounding_floor(x);
  check.limit = kPromiseLimit;
  if (size > 0 && std::isfinite(own / size)) check.limit = std::max(check.limit, own / size);
  if (steepest == 0) {
    check.value = 0;
    return;
  }
  const Vector d = (-g / steepest).cwiseMax(room_below(u)).cwiseMin(room_above(u));
  const double slope = -g.dot(d);
  check.value = slope / size;  // infinite at cost 0 with a gradient
  check.refuted = false;
  if (check.holds()) return;
  constexpr double kProbe = 1e-4;
  problem.cost_and_gradient(box.to_parameters(u + kProbe * d), full);
  const double curvature = (box.gradient_to_unit(full) - g).dot(d) / kProbe;
  const double length = curvature > 0 ? std::min(1.0, slope / curvature) : 1.0;
  check.refuted = length * (slope - 0.5 * length * std::max(curvature, 0.0)) > check.limit * size;
}

}  // namespace

std::string OptimalityCheck::text() const {
  if (std::isnan(value)) return fmt::format("{}: cost or derivatives are not finite there", test);
  return fmt::format("{} promises {:.2g} {} {:.2g} of the cost", test, value, holds() ? "<=" : ">", limit);
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
  check.refuted = true;
  if (own.has_normal_equations()) {
    check.test = "a bounded Gauss-Newton step";
    if (own.forms_normal_equations())
      check_residuals(check, own, x, box);
    else
      check_normal_equations(check, own, x, box);
    check.refuted = !check.holds();
  } else if (own.has_gradient()) {
    check.test = "a projected-gradient step";
    check_gradient(check, own, x, box);
  } else {
    return std::nullopt;
  }
  check.evaluations = own.counts().total();
  return check;
}

double bounded_promise(const Vector& u, const NormalEquations& e) {
  if (e.cost == 0) return 0;
  return promised_gain(linear_model(e), room_below(u), room_above(u));
}

}  // namespace odobench
