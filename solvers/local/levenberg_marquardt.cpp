#include "solvers/local/levenberg_marquardt.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "solvers/local/local_model.hpp"

namespace odobench {
namespace {

constexpr double kLargestDamping = 1e20;
// Differences of costs that are this part of them are mostly rounding.
constexpr double kUnresolved = 1e-14;

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

// One path from the start of the run, which can be taken up again.
class Descent {
 public:
  Descent(Run& run, const LevenbergMarquardtOptions& options, StepScale scale)
      : run_(run),
        options_(options),
        u_(run.start()),
        model_(run.problem(), scale),
        damping_(options.lambda) {}

  // At most `iterations` further ones. IterationLimit: it can go on.
  Outcome advance(int iterations) {
    if (!evaluated_ && !model_.evaluate(run_, u_)) {
      if (run_.stop()) return {};
      return {Termination::Failed, "the cost or its derivatives at the start are not finite"};
    }
    evaluated_ = true;
    for (int k = 0; k < iterations; ++k) {
      if (const auto end = step()) return *end;
      ++iterations_;
    }
    return {Termination::IterationLimit,
            fmt::format("{} iterations >= limit {}", iterations_, options_.iterations)};
  }
  double cost() const { return model_.cost(); }
  int iterations() const { return iterations_; }

 private:
  // One accepted or rejected step; why the path ends where it does.
  std::optional<Outcome> step() {
    if (model_.cost() == 0) return Outcome{Termination::Settled, "cost 0: an exact fit"};
    const double projected = model_.projected_cosine(u_);
    if (projected <= options_.gradient_tolerance)
      return Outcome{Termination::Settled, fmt::format("projected gradient {:.2g} <= {:.2g} (relative)",
                                                       projected, options_.gradient_tolerance)};
    const Vector lower = -(u_.array() + 1.0).matrix(), upper = (1.0 - u_.array()).matrix();
    const Vector d = model_.step(damping_.value(), lower, upper);
    const double predicted = model_.decrease(d);
    const double limit = std::max(options_.cost_tolerance, model_.rounding_part(run_, u_));
    if (!(predicted > limit)) {
      const double promise = model_.decrease(model_.step(0, lower, upper));
      if (!(promise > limit))
        return Outcome{Termination::Settled,
                       fmt::format("predicted decrease {:.2g} <= {:.2g} times the cost", promise, limit)};
    }
    if (damping_.value() > kLargestDamping)
      return Outcome{Termination::Stalled, fmt::format("damping {:.2g} > {:.0e}, projected gradient {:.2g}",
                                                       damping_.value(), kLargestDamping, projected)};
    const Vector candidate = (u_ + d).cwiseMax(-1.0).cwiseMin(1.0);
    const double before = model_.cost();
    const double cost = run_.cost(candidate);
    if (run_.stop()) return Outcome{};
    run_.iteration();
    const bool better = cost < before && model_.evaluate(run_, candidate);
    if (run_.stop()) return Outcome{};
    if (better) {
      u_ = candidate;
      damping_.accepted((before - cost) / (predicted * before));
      return std::nullopt;
    }
    damping_.rejected();
    if (predicted > kUnresolved) return std::nullopt;
    const double promise = model_.decrease(model_.step(0, lower, upper));
    if (promise > 10 * kUnresolved) return std::nullopt;
    return Outcome{
        Termination::Settled,
        fmt::format("a predicted decrease of {:.2g} times the cost is lost in its rounding, the undamped "
                    "one is {:.2g} <= {:.0e}",
                    predicted, promise, 10 * kUnresolved)};
  }

  Run& run_;
  const LevenbergMarquardtOptions& options_;
  Vector u_;
  LocalModel model_;
  Damping damping_;
  bool evaluated_ = false;
  int iterations_ = 0;
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
  binder.integer(
      "patience", patience,
      "iterations after which a second path, whose steps are scaled by the box, is tried (0: never)", 0);
}

void LevenbergMarquardtOptions::validate() const {}

std::string LevenbergMarquardt::why_not(const Problem& problem) const {
  return problem.has_normal_equations() ? "" : "needs residuals with a Jacobian, the problem has none";
}

Outcome LevenbergMarquardt::minimise(Run& run) const {
  Descent first(run, options_, StepScale::LargestColumn);
  Outcome outcome = first.advance(options_.patience > 0 ? std::min(options_.patience, options_.iterations)
                                                        : options_.iterations);
  const bool crawls = outcome.termination == Termination::IterationLimit;
  if (run.stop() || options_.patience == 0 || first.iterations() >= options_.iterations ||
      (!crawls && outcome.termination != Termination::Stalled))
    return outcome;

  Descent second(run, options_, StepScale::Box);
  const Outcome other = second.advance(std::min(options_.patience, options_.iterations - first.iterations()));
  if (run.stop()) return {};
  const bool better = second.cost() < first.cost();
  Descent& chosen = better ? second : first;
  if (better) outcome = other;
  if (outcome.termination == Termination::IterationLimit)
    outcome = chosen.advance(options_.iterations - first.iterations() - second.iterations());
  outcome.message += fmt::format("; the better of two scalings of the step, the other one's cost {:.6g}",
                                 (better ? first : second).cost());
  return outcome;
}

SolverEntry levenberg_marquardt_entry() {
  return make_entry<LevenbergMarquardt, LevenbergMarquardtOptions>(
      "lm", "Levenberg-Marquardt whose step solves the box-constrained linear model", false);
}

}  // namespace odobench
