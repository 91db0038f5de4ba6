// The one driver of every solver: budget, clock, target, interruption, best-so-far, trace and evaluation
// counts live here; a solver is only its method. Solvers work in the unit box of solvers/box/box.hpp: u in
// [-1, 1]^m.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "base/random.hpp"
#include "problems/problem.hpp"
#include "solvers/box/box.hpp"

namespace odobench {

enum class Termination {
  NotStarted,
  Converged,  // said by solve() alone: the test of solvers/certificate/verdict.hpp holds at the returned point
  Settled,    // the method ended by its own tolerance, and there are no derivatives to tell what that means
  Stalled,    // no further progress, and optimality is not shown or is refuted
  IterationLimit,  // the method's own iteration or generation count is used up
  TargetReached,
  MaxEvaluations,
  TimeLimit,
  Interrupted,
  Failed,  // the method broke down; the best point so far is still reported
  NotApplicable
};
std::string to_string(Termination termination);  // "converged", "max_evaluations", ...

// 0 means unlimited for the counts and seconds.
struct Budget {
  std::int64_t max_evaluations = 0;  // cost, gradient, residual and normal-equation calls together
  double max_seconds = 0;
  double target_cost = -std::numeric_limits<double>::infinity();  // stop when best <= target
};

struct Progress {
  std::int64_t evaluations = 0;
  std::int64_t iterations = 0;
  double seconds = 0;
  double best_cost = std::numeric_limits<double>::infinity();
};
// Called after iterations, at most every 50 ms, from the thread of the run.
using Observer = std::function<void(const Progress&)>;

struct TraceEntry {
  std::int64_t evaluations;
  double seconds;
  double cost;
};

class Run {
 public:
  // `start` in parameter units; `interrupt` (may be null) is polled before every evaluation. `threads` > 1
  // lets batch_cost share its candidates among the threads of the calling tbb::task_arena; the values do not
  // depend on it.
  Run(const Problem& problem, const Budget& budget, const Vector& start, std::uint64_t seed,
      const std::atomic<bool>* interrupt = nullptr, Observer observer = {}, int threads = 1);

  const Problem& problem() const { return problem_; }
  const Box& box() const { return box_; }
  Eigen::Index dimension() const { return box_.dimension(); }
  const Vector& start() const { return start_; }  // unit coordinates
  Random& random() { return random_; }

  // Evaluations. Once stop() holds they return +infinity (derivatives zero) without calling the model, so a
  // budget is never exceeded. A non-finite cost is counted and handed to the method as +infinity; so is a
  // point whose derivatives are not finite (its cost still counts for the best).
  double cost(const ConstVectorRef& u);
  double cost_and_gradient(const ConstVectorRef& u, VectorRef g);
  double normal_equations(const ConstVectorRef& u, NormalEquations& out);  // out in unit coordinates
  double residuals_and_jacobian(const ConstVectorRef& u, VectorRef r, MatrixRef j);
  // candidates m x k, one per column; costs k. Candidates beyond the budget get +infinity.
  void batch_cost(const ConstMatrixRef& candidates, VectorRef costs);

  // A walk on the problem's lattice, in parameter units. lattice_point gives the admissible point nearest to
  // start(); lattice_change is +infinity once stop() holds; lattice_visit takes the point, whose cost
  // is known by walking there, into account for the best: also after a stop.
  std::unique_ptr<LatticePoint> lattice_point();
  double lattice_change(const LatticePoint& point, Eigen::Index i, double value);
  void lattice_visit(const LatticePoint& point);

  // True when the method must return; the reason is kept. Cheap: methods and adapters ask as often as they
  // like.
  bool stop();
  // One iteration of the method is done: counts it and tells the observer.
  void iteration();

  bool has_best() const { return best_cost_ < std::numeric_limits<double>::infinity(); }
  double best_cost() const { return best_cost_; }
  const Vector& best() const { return best_; }                        // unit coordinates
  const Vector& best_parameters() const { return best_parameters_; }  // parameter units, inside the box
  std::int64_t evaluations() const { return problem_.counts().total(); }
  // Evaluations left, a very large number without a limit.
  std::int64_t evaluations_left() const;
  std::int64_t iterations() const { return iterations_; }
  std::int64_t non_finite() const { return non_finite_; }
  double seconds() const;
  const EvaluationCounts& counts() const { return problem_.counts(); }
  const std::vector<TraceEntry>& trace() const { return trace_; }
  const Budget& budget() const { return budget_; }
  // Why stop() holds, NotStarted while it does not, and the sentence with both numbers.
  Termination stop_reason() const { return stop_reason_; }
  std::string stop_message() const;

  // A run of its own from `start` (unit coordinates), of at most `most` evaluations (0: no limit but this
  // run's) and within what this run has left. What it did counts here once absorb() has taken it in.
  Run local(const ConstVectorRef& start, std::int64_t most);
  void absorb(const Run& local);

  // Begins a following phase (polish) at the best point: start() is the best point, the budget is replaced,
  // counts, clock, trace and best go on; a stop for evaluations or time is reconsidered.
  void restart_from_best(const Budget& budget);

 private:
  double accept(double cost, const Vector& parameters, const ConstVectorRef& u);
  bool has_derivatives(double cost, bool finite);
  void consider(double cost, const Vector& parameters, const ConstVectorRef& u);

  Problem problem_;
  Box box_;
  Budget budget_;
  Vector start_;
  Random random_;
  const std::atomic<bool>* interrupt_;
  Observer observer_;
  int threads_;
  std::chrono::steady_clock::time_point begin_;
  double last_report_ = -1;
  std::int64_t iterations_ = 0;
  std::int64_t non_finite_ = 0;
  double best_cost_ = std::numeric_limits<double>::infinity();
  Vector best_, best_parameters_;
  std::vector<TraceEntry> trace_;
  Termination stop_reason_ = Termination::NotStarted;
};

}  // namespace odobench
