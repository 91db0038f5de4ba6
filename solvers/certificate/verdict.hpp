// The one place that says `converged`: a test of first-order optimality at the point a run returns, made by
// the driver and not by the method, in units that a factor on the cost or on the parameters does not change.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "problems/problem.hpp"

namespace odobench {

// What was tested at the returned point. `value` is what a step inside the box still promises, as a part of
// the present cost; not-a-number where cost or derivatives are not finite there, which never holds.
struct OptimalityCheck {
  std::string test;
  double value = 0;
  double limit = 0;
  std::int64_t evaluations = 0;  // made for it, not among those of the run

  bool holds() const { return value <= limit; }
  std::string text() const;  // "a bounded Gauss-Newton step promises 3e-17 <= 1e-08 of the cost"
};

// A step that promises at most this part of the cost is none.
inline constexpr double kPromiseLimit = 1e-8;

// x (n) inside the box. Nothing where the problem has no derivatives: then nobody can say. What is tested:
//   residuals or normal equations   the bounded Gauss-Newton step: max over u + d in the box of 1 - |r + J
//   d|^2 / |r|^2;
//                                   one evaluation.
//   a gradient only                 the bounded Newton step, second derivatives by differences of gradients
//   (n + 1
//                                   evaluations); downward curvature along a free direction counts as a step,
//                                   too.
// limit is kPromiseLimit, or what rounding alone explains where that is more: the cost's own floor
// (Problem::rounding_floor), or the change of the cost when every parameter moves by two units in its last
// place.
std::optional<OptimalityCheck> check_optimality(const Problem& problem, const ConstVectorRef& x);

// What the bounded Gauss-Newton step promises by derivatives that are differences of residuals alone
// (solvers/certificate/derivative_check.hpp): a second way to the same number, for those who doubt the
// problem's own. Nothing where the problem has no residuals, or where differences do not determine them.
std::optional<double> promise_by_differences(const Problem& problem, const ConstVectorRef& x);

// The same bounded Gauss-Newton promise for methods that want to know whether to go on: derivatives e at u,
// both in unit coordinates.
double bounded_promise(const Vector& u, const NormalEquations& e);

}  // namespace odobench
