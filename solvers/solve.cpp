#include "solvers/solve.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "solvers/registry.hpp"

namespace odobench {
namespace {

Budget main_phase(Budget budget, bool polished) {
  if (!polished) return budget;
  if (budget.max_evaluations > 0)
    budget.max_evaluations = std::max<std::int64_t>(
        1, budget.max_evaluations - std::min<std::int64_t>(budget.max_evaluations / 10, 500));
  budget.max_seconds *= 0.9;
  return budget;
}

Outcome run_phase(const Solver& solver, Run& run) {
  Outcome outcome;
  try {
    outcome = solver.minimise(run);
  } catch (const std::exception& error) {
    outcome = {Termination::Failed, error.what()};
  }
  if (run.stop_reason() != Termination::NotStarted)
    return {run.stop_reason(), run.stop_message(), false, std::move(outcome.optima)};
  // A target met by the last evaluation of a method that then ended by itself.
  if (run.has_best() && run.best_cost() <= run.budget().target_cost && run.stop())
    return {run.stop_reason(), run.stop_message(), false, std::move(outcome.optima)};
  return outcome;
}

// Tests the returned point and says what may be said of it. A method that ended by itself has converged where
// the test holds and has stalled where it does not, whatever the method says; without derivatives it keeps
// its own word.
void conclude(const Problem& problem, const Outcome& outcome, Result& result) {
  const bool by_itself =
      outcome.termination == Termination::Settled || outcome.termination == Termination::Stalled;
  if (outcome.termination == Termination::Converged)
    throw std::logic_error(
        fmt::format("solver '{}' says converged, which only the driver may", result.solver));
  if (!result.usable() || outcome.on_lattice || outcome.termination == Termination::Interrupted ||
      outcome.termination == Termination::Failed)
    return;
  result.check = check_optimality(problem, result.x);
  if (!result.check || !by_itself) return;
  result.termination = result.check->holds() ? Termination::Converged : Termination::Stalled;
  result.message += "; " + result.check->text();
}

}  // namespace

Result solve(const Problem& problem, const SolverSpec& spec, const Vector& start,
             const SolveOptions& options) {
  Result result;
  result.solver = spec.text();
  const SolverTable& known = options.solvers != nullptr ? *options.solvers : known_solvers();
  const std::unique_ptr<Solver> solver = known.find(spec.name).make(spec.options, &result.options);
  const bool polished = !options.polish.name.empty();
  std::unique_ptr<Solver> polisher;
  if (polished) polisher = known.find(options.polish.name).make(options.polish.options, nullptr);

  if (start.size() != problem.dimension() || !start.allFinite())
    throw std::invalid_argument(fmt::format("start: expected {} finite values, found {}{}",
                                            problem.dimension(), start.size(),
                                            start.allFinite() ? "" : ", one of them not finite"));
  result.message = solver->why_not(problem);
  if (result.message.empty() && polished) result.message = polisher->why_not(problem);
  if (!result.message.empty()) {
    result.termination = Termination::NotApplicable;
    return result;
  }

  Run run(problem, main_phase(options.budget, polished), start, options.seed, options.interrupt,
          options.observer, options.threads);
  Outcome outcome;
  if (run.dimension() == 0) {  // every parameter is held fixed: one evaluation is the whole answer
    run.cost(run.start());
    outcome = {Termination::Settled, "nothing to calibrate: every parameter is held fixed (lower == upper)"};
  } else {
    outcome = run_phase(*solver, run);
  }
  if (polished && run.dimension() > 0 && run.has_best() && outcome.termination != Termination::Interrupted &&
      outcome.termination != Termination::TargetReached) {
    result.cost_before_polish = run.best_cost();
    run.restart_from_best(options.budget);
    const Outcome polish = run_phase(*polisher, run);
    outcome = {polish.termination,
               fmt::format("{}; polished by {}: {}", outcome.message, options.polish.text(), polish.message),
               polish.on_lattice, std::move(outcome.optima)};
  }
  result.termination = outcome.termination;
  result.message = outcome.message;
  result.optima = outcome.optima;
  result.counts = run.counts();
  result.iterations = run.iterations();
  result.non_finite = run.non_finite();
  result.seconds = run.seconds();
  result.trace = run.trace();
  if (run.has_best()) {
    result.x = run.best_parameters();
    result.cost = run.best_cost();
  } else if (result.termination != Termination::Interrupted) {
    result.termination = Termination::Failed;
    result.message = fmt::format("no finite cost in {} evaluations; {}", run.evaluations(), outcome.message);
  }
  conclude(problem, outcome, result);
  return result;
}

Vector random_start(const Problem& problem, std::uint64_t seed) {
  Random random(seed);
  const Box box(problem.parameters());
  Vector u(box.dimension());
  for (Eigen::Index i = 0; i < u.size(); ++i) u[i] = random.uniform(-1.0, 1.0);
  return box.to_parameters(u);
}

std::string Result::brief() const {
  if (termination == Termination::NotStarted) return "(not run)";
  if (!usable()) return fmt::format("{}: {}: {}", solver, to_string(termination), message);
  return fmt::format("{}: {:.9g} after {} evaluations, {:.3g} s, {}: {}", solver, cost, counts.total(),
                     seconds, to_string(termination), message);
}

std::string Result::full() const {
  std::string text = brief() + "\n";
  text += fmt::format(
      "  cost calls {}, gradients {}, residuals {}, normal equations {}, iterations {}, non-finite {}\n",
      counts.cost, counts.gradient, counts.residuals, counts.normal_equations, iterations, non_finite);
  for (Eigen::Index i = 0; i < x.size(); ++i) text += fmt::format("  x[{}] = {:.17g}\n", i, x[i]);
  return text;
}

}  // namespace odobench
