#include "solvers/levenberg_marquardt.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <cmath>
#include <limits>

#include "solvers/local_model.hpp"

namespace odobench {
namespace {

constexpr double kLargestDamping = 1e20;

// The damping and how it follows the gain ratio.
class Damping {
 public:
  explicit Damping(double lambda) : lambda_(lambda) {}
  double value() const { return lambda_; }
  void accepted(double rho) {
    lambda_ *= std::max(1.0 / 3.0, 1.0 - std::pow(2.0 * rho - 1.0, 3));
    lambda_ = std::max(lambda_, 1e-60);
    growth_ = 2;
  }
  void rejected() {
    lambda_ *= growth_;
    growth_ *= 2;
  }

 private:
  double lambda_;
  double growth_ = 2;
};

}  // namespace

void LevenbergMarquardtOptions::bind(OptionBinder& binder) {
  binder.number("lambda", lambda, "initial damping, relative to the squared scale of each parameter", 1e-12,
                1e12);
  binder.number("gradient_tolerance", gradient_tolerance,
                "stop when every free |J'r|_i / (|J_i| |r|) is at most this", 0, 1);
  binder.number("cost_tolerance", cost_tolerance,
                "stop when an undamped step promises at most this part of the cost", 0, 1);
  binder.integer("iterations", iterations, "iteration limit", 1);
}

void LevenbergMarquardtOptions::validate() const {}

std::string LevenbergMarquardt::why_not(const Problem& problem) const {
  return problem.has_normal_equations() ? "" : "needs residuals with a Jacobian, the problem has none";
}

Outcome LevenbergMarquardt::minimise(Run& run) const {
  Vector u = run.start();
  LocalModel model(run.problem());
  if (!model.evaluate(run, u)) {
    if (run.stop()) return {};
    return {Termination::Failed, "the cost or its derivatives at the start are not finite"};
  }
  Damping damping(options_.lambda);
  for (int k = 0; k < options_.iterations; ++k) {
    if (model.cost() == 0) return {Termination::Settled, "cost 0: an exact fit"};
    const double projected = model.projected_cosine(u);
    if (projected <= options_.gradient_tolerance)
      return {Termination::Settled, fmt::format("projected gradient {:.2g} <= {:.2g} (relative)", projected,
                                                options_.gradient_tolerance)};
    const Vector lower = -(u.array() + 1.0).matrix(), upper = (1.0 - u.array()).matrix();
    const Vector d = model.step(damping.value(), lower, upper);
    const double predicted = model.decrease(d);
    const double limit = std::max(options_.cost_tolerance, model.rounding_part(run, u));
    if (!(predicted > limit)) {
      const double promise = model.decrease(model.step(0, lower, upper));
      if (!(promise > limit))
        return {Termination::Settled,
                fmt::format("predicted decrease {:.2g} <= {:.2g} times the cost", promise, limit)};
    }
    if (damping.value() > kLargestDamping)
      return {Termination::Stalled, fmt::format("damping {:.2g} > {:.0e}, projected gradient {:.2g}",
                                                damping.value(), kLargestDamping, projected)};
    const Vector candidate = (u + d).cwiseMax(-1.0).cwiseMin(1.0);
    const double before = model.cost();
    const double cost = run.cost(candidate);
    if (run.stop()) return {};
    run.iteration();
    const bool better = cost < before && model.evaluate(run, candidate);
    if (run.stop()) return {};
    if (better) {
      u = candidate;
      damping.accepted((before - cost) / (predicted * before));
    } else {
      damping.rejected();
    }
  }
  return {Termination::IterationLimit,
          fmt::format("{} iterations >= limit {}", options_.iterations, options_.iterations)};
}

SolverEntry levenberg_marquardt_entry() {
  return make_entry<LevenbergMarquardt, LevenbergMarquardtOptions>(
      "lm", "Levenberg-Marquardt whose step solves the box-constrained linear model", false);
}

}  // namespace odobench
