#include "solvers/run.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cmath>

#include "base/parallel.hpp"
#include "base/range.hpp"

namespace odobench {
namespace {

constexpr std::size_t kTraceLimit = 400;
// So many costs, not one of them finite: no method goes on from there.
constexpr std::int64_t kHopeless = 1000;

// Halves the trace, keeping first and last, so that its length stays bounded and its shape does not change.
void thin(std::vector<TraceEntry>& trace) {
  std::vector<TraceEntry> kept;
  for (std::size_t i = 0; i + 1 < trace.size(); i += 2) kept.push_back(trace[i]);
  kept.push_back(trace.back());
  trace = std::move(kept);
}

}  // namespace

std::string to_string(Termination termination) {
  switch (termination) {
    case Termination::NotStarted:
      return "not_started";
    case Termination::Converged:
      return "converged";
    case Termination::Settled:
      return "settled";
    case Termination::Stalled:
      return "stalled";
    case Termination::IterationLimit:
      return "iteration_limit";
    case Termination::TargetReached:
      return "target_reached";
    case Termination::MaxEvaluations:
      return "max_evaluations";
    case Termination::TimeLimit:
      return "time_limit";
    case Termination::Interrupted:
      return "interrupted";
    case Termination::Failed:
      return "failed";
    case Termination::NotApplicable:
      return "not_applicable";
  }
  return "unknown";
}

Run::Run(const Problem& problem, const Budget& budget, const Vector& start, std::uint64_t seed,
         const std::atomic<bool>* interrupt, Observer observer, int threads)
    : problem_(problem),
      box_(problem.parameters()),
      budget_(budget),
      start_(box_.to_unit(start)),
      random_(seed),
      interrupt_(interrupt),
      observer_(std::move(observer)),
      threads_(threads),
      begin_(std::chrono::steady_clock::now()) {}

double Run::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
}

std::int64_t Run::evaluations_left() const {
  if (budget_.max_evaluations <= 0) return std::numeric_limits<std::int64_t>::max();
  return std::max<std::int64_t>(0, budget_.max_evaluations - evaluations());
}

bool Run::stop() {
  if (stop_reason_ != Termination::NotStarted) return true;
  if (interrupt_ != nullptr && interrupt_->load(std::memory_order_relaxed))
    stop_reason_ = Termination::Interrupted;
  else if (best_cost_ <= budget_.target_cost)
    stop_reason_ = Termination::TargetReached;
  else if (non_finite_ >= kHopeless && !has_best())
    stop_reason_ = Termination::Failed;
  else if (evaluations_left() == 0)
    stop_reason_ = Termination::MaxEvaluations;
  else if (budget_.max_seconds > 0 && seconds() >= budget_.max_seconds)
    stop_reason_ = Termination::TimeLimit;
  return stop_reason_ != Termination::NotStarted;
}

std::string Run::stop_message() const {
  switch (stop_reason_) {
    case Termination::TargetReached:
      return fmt::format("cost {:.10g} <= target {:.10g}", best_cost_, budget_.target_cost);
    case Termination::MaxEvaluations:
      return fmt::format("{} evaluations >= limit {}", evaluations(), budget_.max_evaluations);
    case Termination::TimeLimit:
      return fmt::format("time limit of {:g} s is used up", budget_.max_seconds);
    case Termination::Failed:
      return fmt::format("not one of {} costs is finite", non_finite_);
    case Termination::Interrupted:
      return fmt::format("interrupted after {} evaluations", evaluations());
    default:
      return {};
  }
}

Run Run::local(const ConstVectorRef& start, std::int64_t most) {
  Budget budget = budget_;
  if (budget.max_evaluations > 0) budget.max_evaluations = std::max<std::int64_t>(1, evaluations_left());
  if (most > 0)
    budget.max_evaluations = budget.max_evaluations > 0 ? std::min(budget.max_evaluations, most) : most;
  if (budget.max_seconds > 0) budget.max_seconds = std::max(1e-9, budget.max_seconds - seconds());
  Observer observer;
  if (observer_)
    observer = [tell = observer_, evaluations = evaluations(), iterations = iterations_, seconds = seconds(),
                best = best_cost_](const Progress& p) {
      tell({evaluations + p.evaluations, iterations + p.iterations, seconds + p.seconds,
            std::min(best, p.best_cost)});
    };
  return Run(problem_, budget, box_.to_parameters(start), random_.engine()(), interrupt_, std::move(observer),
             threads_);
}

void Run::absorb(const Run& local) {
  const std::int64_t before = evaluations();
  const double began = seconds() - local.seconds();
  problem_.count(local.counts());
  iterations_ += local.iterations_;
  non_finite_ += local.non_finite_;
  for (const TraceEntry& entry : local.trace_) {
    if (!(entry.cost < best_cost_)) continue;
    best_cost_ = entry.cost;
    trace_.push_back({before + entry.evaluations, began + entry.seconds, entry.cost});
    if (trace_.size() > kTraceLimit) thin(trace_);
  }
  if (local.best_cost_ <= best_cost_ && local.has_best()) {  // its trace ends with its best
    best_cost_ = local.best_cost_;
    best_ = local.best_;
    best_parameters_ = local.best_parameters_;
  }
}

void Run::restart_from_best(const Budget& budget) {
  budget_ = budget;
  start_ = best_;
  if (stop_reason_ == Termination::MaxEvaluations || stop_reason_ == Termination::TimeLimit)
    stop_reason_ = Termination::NotStarted;
}

void Run::consider(double cost, const Vector& parameters, const ConstVectorRef& u) {
  if (!(cost < best_cost_)) return;
  best_cost_ = cost;
  best_parameters_ = parameters;
  best_ = u.cwiseMax(-1.0).cwiseMin(1.0);
  trace_.push_back({evaluations(), seconds(), cost});
  if (trace_.size() > kTraceLimit) thin(trace_);
}

double Run::accept(double cost, const Vector& parameters, const ConstVectorRef& u) {
  if (!std::isfinite(cost)) {
    ++non_finite_;
    return kInfinity;
  }
  consider(cost, parameters, u);
  return cost;
}

bool Run::has_derivatives(double cost, bool finite) {
  if (!std::isfinite(cost)) return false;  // counted already
  if (!finite) ++non_finite_;
  return finite;
}

double Run::cost(const ConstVectorRef& u) {
  if (stop()) return kInfinity;
  const Vector x = box_.to_parameters(u);
  return accept(problem_.cost(x), x, u);
}

double Run::cost_and_gradient(const ConstVectorRef& u, VectorRef g) {
  g.setZero();
  if (stop()) return kInfinity;
  const Vector x = box_.to_parameters(u);
  Vector full(x.size());
  const double cost = accept(problem_.cost_and_gradient(x, full), x, u);
  if (!has_derivatives(cost, full.allFinite())) return kInfinity;
  g = box_.gradient_to_unit(full);
  return cost;
}

double Run::normal_equations(const ConstVectorRef& u, NormalEquations& out) {
  const Eigen::Index m = dimension();
  out = {kInfinity, Vector::Zero(m), Matrix::Zero(m, m)};
  if (stop()) return kInfinity;
  const Vector x = box_.to_parameters(u);
  NormalEquations full;
  problem_.normal_equations(x, full);
  const double cost = accept(full.cost, x, u);
  if (!has_derivatives(cost, full.jtr.allFinite() && full.jtj.allFinite())) return kInfinity;
  out = box_.to_unit(full);
  return cost;
}

double Run::residuals_and_jacobian(const ConstVectorRef& u, VectorRef r, MatrixRef j) {
  r.setZero();
  j.setZero();
  if (stop()) return kInfinity;
  const Vector x = box_.to_parameters(u);
  Matrix full(problem_.residual_count(), x.size());
  problem_.residuals_and_jacobian(x, r, full);
  const double cost = accept(r.squaredNorm(), x, u);
  if (!has_derivatives(cost, full.allFinite())) return kInfinity;
  j = box_.jacobian_to_unit(full);
  return cost;
}

void Run::batch_cost(const ConstMatrixRef& candidates, VectorRef costs) {
  costs.setConstant(kInfinity);
  if (stop()) return;
  const Eigen::Index count = std::min<std::int64_t>(candidates.cols(), evaluations_left());
  Matrix x(problem_.dimension(), count);
  for (Eigen::Index k = 0; k < count; ++k) x.col(k) = box_.to_parameters(candidates.col(k));

  // Chunks of a fixed size, whatever the thread count, so that a reached target, an interruption or the clock
  // end a large batch early and at the same candidate.
  constexpr Eigen::Index kChunk = 32;
  constexpr Eigen::Index kSlice = 8;
  Vector values(kChunk);
  for (Eigen::Index done = 0; done < count && !stop(); done += kChunk) {
    const Eigen::Index width = std::min(count - done, kChunk);
    const auto slice = [&](Eigen::Index first, Eigen::Index last) {
      problem_.batch_cost(x.middleCols(done + first, last - first), values.segment(first, last - first));
    };
    if (threads_ > 1 && width > kSlice) {
      Meeting meeting;
      meeting.arrive();
      tbb::this_task_arena::isolate([&] {
        tbb::parallel_for(Eigen::Index{0}, (width + kSlice - 1) / kSlice, [&](Eigen::Index i) {
          meeting.arrive();
          slice(i * kSlice, std::min((i + 1) * kSlice, width));
          meeting.arrive();
        });
      });
      meeting.arrive();
    } else {
      slice(0, width);
    }
    for (Eigen::Index k = 0; k < width; ++k)
      costs[done + k] = accept(values[k], x.col(done + k), candidates.col(done + k));
  }
}

std::unique_ptr<LatticePoint> Run::lattice_point() {
  Vector x = box_.to_parameters(start_);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const Vector& levels = problem_.lattice_levels()[static_cast<std::size_t>(i)];
    Eigen::Index nearest = 0;
    (levels.array() - x[i]).abs().minCoeff(&nearest);
    x[i] = levels[nearest];
  }
  return problem_.lattice_point(x);
}

double Run::lattice_change(const LatticePoint& point, Eigen::Index i, double value) {
  if (stop()) return kInfinity;
  const double change = problem_.lattice_change(point, i, value);
  if (std::isfinite(change)) return change;
  ++non_finite_;
  return kInfinity;
}

void Run::lattice_visit(const LatticePoint& point) {
  accept(point.cost(), point.x(), box_.to_unit(point.x()));
}

void Run::iteration() {
  ++iterations_;
  if (!observer_) return;
  const double now = seconds();
  if (last_report_ >= 0 && now - last_report_ < 0.05) return;
  last_report_ = now;
  observer_({evaluations(), iterations_, now, best_cost_});
}

}  // namespace odobench
