// One cell of a table: a problem, a solver, a start, a seed, a budget -> a result.
#pragma once

#include "solvers/certificate/verdict.hpp"
#include "solvers/registry.hpp"
#include "solvers/solver.hpp"

namespace odobench {

struct SolveOptions {
  Budget budget;
  std::uint64_t seed = 0;
  const std::atomic<bool>* interrupt = nullptr;
  Observer observer;
  int threads = 1;
  // Solver that goes on from the best point found, e.g. "lm"; the name "" means none. It spends from the same
  // budget: min(max_evaluations / 10, 500) evaluations and a tenth of the time are kept for it.
  SolverSpec polish;
  // Where solvers are looked up; null: known_solvers().
  const SolverTable* solvers = nullptr;
};

struct Result {
  std::string solver;    // label: name with the options given
  OptionValues options;  // every option with the value in force
  Termination termination = Termination::NotStarted;
  std::string message;
  Vector x;  // parameter units, inside the box; empty when nothing was evaluated
  double cost = std::numeric_limits<double>::quiet_NaN();
  std::optional<double> cost_before_polish;
  EvaluationCounts counts;
  std::int64_t iterations = 0;
  std::int64_t non_finite = 0;
  double seconds = 0;
  std::vector<TraceEntry> trace;
  // Of the returned point; absent where the problem has no derivatives and after an interruption or a
  // failure.
  std::optional<OptimalityCheck> check;

  // Distinct optima, the lowest first, of a method that starts many times.
  std::vector<LocalOptimum> optima;

  bool usable() const { return x.size() > 0; }
  std::string brief() const;  // "lm: 98.1187829 after 30 evaluations, 0.04 s, converged: ..."
  std::string full() const;   // several lines, with the parameters
};

// `start` in parameter units (n), finite. Throws std::invalid_argument on unknown solvers, bad options or
// such a start; everything that happens while running is in the result: a method that cannot run gives
// NotApplicable with the reason, a method that throws gives Failed with its message and the best point so
// far.
Result solve(const Problem& problem, const SolverSpec& solver, const Vector& start,
             const SolveOptions& options);

// A point drawn uniformly from the box.
Vector random_start(const Problem& problem, std::uint64_t seed);

}  // namespace odobench
