#include "solvers/libraries/nlopt_solvers.hpp"

#include <fmt/format.h>
#include <nlopt.h>

#include <chrono>
#include <cmath>
#include <exception>
#include <mutex>

#include "base/range.hpp"
#include "solvers/box/boundary_map.hpp"
#include "solvers/certificate/optimality.hpp"
#include "solvers/libraries/nlopt_algorithms.hpp"

namespace odobench {
namespace {

// StoGO and AGS know no forced stop. AGS ends when a value lies below its stop value, so it is handed one far
// below.
constexpr double kStopValue = -1e200;
constexpr double kBelowStopValue = -1e250;
constexpr double kFold = 0.5;  // width of the bent zone for methods without bounds, in units of half the box
constexpr int kMostBrokenOff = 1000;
struct LeaveStogo {};  // StoGO is C++ with automatic storage: an exception leaves it cleanly

using Handle = std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)>;

const std::vector<NloptAlgorithm>& local_methods() {
  static const std::vector<NloptAlgorithm> rows = [] {
    std::vector<NloptAlgorithm> list;
    for (const NloptAlgorithm& row : nlopt_algorithms())
      if (!row.global) list.push_back(row);
    return list;
  }();
  return rows;
}

const NloptAlgorithm& local_method(const std::string& name) {
  for (const NloptAlgorithm& row : local_methods())
    if (row.name == name) return row;
  throw std::logic_error("unknown local method " + name);
}

// What NLopt minimises: the scaled cost of a Run.
class Objective {
 public:
  Objective(Run& run, const NloptAlgorithm& algorithm) : run_(run), algorithm_(algorithm) {}

  // Costs are divided by this one from now on; what was remembered in the old unit is forgotten.
  void set_scale(double cost) {
    if (!std::isfinite(cost) || cost == 0) return;
    // The inverse of a denormal number is infinite.
    scale_ = std::min(1.0 / std::abs(cost), std::numeric_limits<double>::max());
    worst_ = 0;
    lowest_ = kInfinity;
    gradient_.resize(0);
    gradient_at_.resize(0);
  }
  void attach(nlopt_opt handle) { handle_ = handle; }
  int evaluations() const { return evaluations_; }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }
  bool has_gradient() const { return gradient_at_.size() > 0; }
  // Gradient of the scaled cost at the lowest point where one was evaluated, and that point.
  const Vector& gradient() const { return gradient_; }
  const Vector& gradient_at() const { return gradient_at_; }
  double lowest() const { return std::abs(lowest_); }

  static double call(unsigned n, const double* x, double* gradient, void* self) {
    return static_cast<Objective*>(self)->evaluate(n, x, gradient);
  }

 private:
  double evaluate(unsigned n, const double* x, double* gradient) {
    const auto m = static_cast<Eigen::Index>(n);
    ++calls_;
    if (gradient != nullptr) std::fill(gradient, gradient + n, 0.0);
    double cost = kInfinity;
    Vector g;
    try {
      if (!error_ && !run_.stop()) {
        ++evaluations_;
        const Eigen::Map<const Vector> at(x, m);
        const Vector folded = algorithm_.folded ? Vector(BoundaryMap(kFold).to_box(at)) : Vector();
        const ConstVectorRef u = algorithm_.folded ? ConstVectorRef(folded) : ConstVectorRef(at);
        if (gradient != nullptr) {
          g.resize(m);
          cost = run_.cost_and_gradient(u, g);
        } else {
          cost = run_.cost(u);
        }
        run_.iteration();
      }
    } catch (...) {
      error_ = std::current_exception();
    }
    if (error_ || run_.stop()) return leave(n);
    const double value = scale_ * cost;
    if (!std::isfinite(value)) return worst_ + std::abs(worst_) + 1.0;
    worst_ = std::max(worst_, value);
    if (gradient != nullptr) {
      Eigen::Map<Vector>(gradient, m) = scale_ * g;
      if (value < lowest_) {
        lowest_ = value;
        gradient_ = scale_ * g;
        gradient_at_ = Eigen::Map<const Vector>(x, m);
      }
    }
    return value;
  }

  double leave(unsigned n) {
    // Gablonsky's code reads an unset index when it is stopped within its first 2 n + 1 points.
    if (!algorithm_.late_stop || calls_ > 2 * static_cast<std::int64_t>(n) + 1) nlopt_force_stop(handle_);
    if (algorithm_.statics && algorithm_.gradient) throw LeaveStogo{};
    if (algorithm_.statics) return kBelowStopValue;
    return worst_ + std::abs(worst_) + 1.0;
  }

  Run& run_;
  const NloptAlgorithm& algorithm_;
  nlopt_opt handle_ = nullptr;
  double scale_ = 1;
  double worst_ = 0;
  double lowest_ = kInfinity;
  int evaluations_ = 0;
  std::int64_t calls_ = 0;  // with those after the driver's stop, which evaluate nothing
  Vector gradient_, gradient_at_;
  std::exception_ptr error_;
};

// The mutex of the algorithms with static variables; waiting for it ends when the driver says stop.
class StaticsLock {
 public:
  StaticsLock(Run& run, bool needed) {
    if (!needed) return;
    static std::timed_mutex mutex;
    lock_ = std::unique_lock<std::timed_mutex>(mutex, std::defer_lock);
    while (!lock_.try_lock_for(std::chrono::milliseconds(10)) && !run.stop()) {
    }
  }

 private:
  std::unique_lock<std::timed_mutex> lock_;
};

void set_tolerances(nlopt_opt handle, double xtol, double ftol) {
  nlopt_set_xtol_rel(handle, xtol);
  nlopt_set_xtol_abs1(handle, xtol);  // the box has half-width 1: also a relative measure
  nlopt_set_ftol_rel(handle, ftol);
}

Handle make_handle(const NloptOptions& options, Objective& objective, Eigen::Index dimension) {
  const NloptAlgorithm& algorithm = *options.algorithm;
  const auto n = static_cast<unsigned>(dimension);
  Handle handle(nlopt_create(algorithm.id, n), &nlopt_destroy);
  if (!handle) throw std::runtime_error(fmt::format("NLopt: no memory for {} parameters", n));
  if (!algorithm.folded) {
    nlopt_set_lower_bounds1(handle.get(), -1.0);
    nlopt_set_upper_bounds1(handle.get(), 1.0);
  }
  nlopt_set_min_objective(handle.get(), &Objective::call, &objective);
  set_tolerances(handle.get(), options.xtol, options.ftol);
  if (algorithm.statics && !algorithm.gradient) nlopt_set_stopval(handle.get(), kStopValue);
  if (options.step > 0) nlopt_set_initial_step1(handle.get(), options.step);
  if (options.population > 0) nlopt_set_population(handle.get(), static_cast<unsigned>(options.population));
  if (algorithm.memory) nlopt_set_vector_storage(handle.get(), static_cast<unsigned>(options.memory));
  if (algorithm.local) {
    const NloptAlgorithm& method = local_method(options.local);
    const Handle local(nlopt_create(method.id, n), &nlopt_destroy);
    set_tolerances(local.get(), options.local_xtol, options.ftol);
    if (method.memory) nlopt_set_vector_storage(local.get(), 100);
    nlopt_set_local_optimizer(handle.get(), local.get());
  }
  objective.attach(handle.get());
  return handle;
}

std::string in_words(nlopt_result code, const NloptOptions& options) {
  switch (code) {
    case NLOPT_FTOL_REACHED:
      return fmt::format("relative change of the cost <= {:g}", options.ftol);
    case NLOPT_XTOL_REACHED:
      return fmt::format("change of the parameters <= {:g} of the box", options.xtol);
    case NLOPT_ROUNDOFF_LIMITED:
      return "progress is limited by rounding";
    case NLOPT_SUCCESS:
      return "the method says success";
    case NLOPT_FAILURE:
      return "the method found no further step";
    default:
      return nlopt_result_to_string(code);
  }
}

// One call of NLopt from the best point so far.
nlopt_result start_once(Run& run, nlopt_opt handle, const Objective& objective, bool folded,
                        int evaluations) {
  nlopt_set_maxeval(handle, evaluations);
  Vector u = run.has_best() ? run.best() : run.start();
  if (folded) u = BoundaryMap(kFold).from_box(u);
  double value = 0;
  nlopt_result code = NLOPT_FORCED_STOP;
  try {
    code = nlopt_optimize(handle, u.data(), &value);
  } catch (const LeaveStogo&) {
  }
  objective.rethrow();
  return code;
}

// Ended by one of its tolerances, which say that it has stopped moving and not that it has arrived.
Outcome ended(nlopt_result code, const std::string& how) {
  const bool by_tolerance = code == NLOPT_FTOL_REACHED || code == NLOPT_XTOL_REACHED || code == NLOPT_SUCCESS;
  return {by_tolerance ? Termination::Settled : Termination::Stalled, how};
}

// The projected gradient at the lowest point that has one, relative to the cost there; coordinates next to a
// bound that
// -g points to count as on it, and that point is evaluated. No number without a gradient.
double slope_on_bounds(Run& run, const Objective& objective, double xtol) {
  if (!objective.has_gradient()) return std::numeric_limits<double>::infinity();
  const Vector u = put_on_bounds(objective.gradient_at(), objective.gradient(), xtol);
  if (u != objective.gradient_at()) run.cost(u);
  return projected_gradient(u, objective.gradient()) / objective.lowest();
}

}  // namespace

void NloptOptions::bind(OptionBinder& binder) {
  binder.number("xtol", xtol, "stop when the parameters change by at most this part of the box", 0, 1);
  binder.number("ftol", ftol, "stop when the cost changes by at most this times itself", 0, 1);
  binder.integer("evaluations", evaluations, "evaluation limit of its own", 1);
  if (algorithm->gradient && !algorithm->global)
    binder.number("gradient_tolerance", gradient_tolerance,
                  "no further start when the projected gradient is at most this part of the cost", 0, 1);
  if (!algorithm->global) {
    binder.integer("restarts", restarts, "further starts from the best point while they gain", 0, 1000);
    binder.number("restart_gain", restart_gain,
                  "relative gain of a start below which there is no further one", 0, 1);
  }
  if (algorithm->step)
    binder.automatic("step", step, "initial step in units of half the box; auto: NLopt's choice", 1e-12, 2);
  if (algorithm->population)
    binder.automatic("population", population, "population size; auto: NLopt's choice", 2,
                     kLargestPopulation);
  if (algorithm->memory) binder.integer("memory", memory, "gradient pairs kept", 1, 10000);
  if (algorithm->local) {
    std::vector<std::string> names;
    for (const NloptAlgorithm& row : local_methods()) names.push_back(row.name);
    binder.choice("local", local, "local method", std::move(names));
    binder.number("local_xtol", local_xtol, "xtol of the local method", 1e-8, 1);
  }
}

std::string NloptSolver::why_not(const Problem& problem) const {
  const NloptAlgorithm& algorithm = *options_.algorithm;
  const Eigen::Index free = Box(problem.parameters()).dimension();
  if (algorithm.most_parameters > 0 && free > algorithm.most_parameters)
    return fmt::format("takes at most {} free parameters, the problem has {}", algorithm.most_parameters,
                       free);
  if (algorithm.not_for_one && free == 1) return "needs at least two free parameters, the problem has one";
  if (algorithm.gradient && !problem.has_gradient()) return "needs a gradient, the problem has none";
  if (algorithm.local && local_method(options_.local).gradient && !problem.has_gradient())
    return fmt::format("local={} needs a gradient, the problem has none; local=bobyqa needs none",
                       options_.local);
  return "";
}

Outcome NloptSolver::minimise(Run& run) const {
  const NloptAlgorithm& algorithm = *options_.algorithm;
  const StaticsLock statics(run, algorithm.statics);
  if (run.stop()) return {};
  nlopt_srand(static_cast<unsigned long>(run.random().engine()() & 0xffffffffu));
  const double start_cost = run.cost(run.start());
  if (run.stop()) return {};
  if (algorithm.gradient && !std::isfinite(start_cost))
    return {Termination::Failed, "the cost at the start is not finite"};

  Objective objective(run, algorithm);
  objective.set_scale(start_cost);
  const Handle handle = make_handle(options_, objective, run.dimension());
  double before = start_cost;
  for (int round = 0;; ++round) {
    const int left = options_.evaluations - objective.evaluations();
    if (left <= 0)
      return {Termination::IterationLimit, fmt::format("{} evaluations >= limit {} of the method",
                                                       objective.evaluations(), options_.evaluations)};
    const nlopt_result code = start_once(run, handle.get(), objective, algorithm.folded, left);
    if (run.stop()) return {};
    if (code == NLOPT_INVALID_ARGS || code == NLOPT_OUT_OF_MEMORY) {
      const char* detail = nlopt_get_errmsg(handle.get());
      return {Termination::Failed, fmt::format("NLopt: {}{}{}", nlopt_result_to_string(code),
                                               detail ? ": " : "", detail ? detail : "")};
    }
    if (code == NLOPT_MAXEVAL_REACHED) {
      if (objective.evaluations() >= options_.evaluations) continue;  // reported above
      return {Termination::IterationLimit,
              fmt::format("{} evaluations: NLopt's own limit", objective.evaluations())};
    }
    // MLSL gives up when one of its local searches fails: it is sent on. Other global methods are done.
    const bool broken_off = algorithm.local && code < 0 && round < kMostBrokenOff;
    if (broken_off) continue;
    if (algorithm.global) return ended(code, in_words(code, options_));
    if (algorithm.gradient && round == 0 && !objective.has_gradient())
      return {Termination::Failed, "the derivatives at the start are not finite"};
    const double slope = slope_on_bounds(run, objective, options_.xtol);
    if (run.stop()) return {};

    const double gain =
        before == run.best_cost() ? 0.0 : (before - run.best_cost()) / std::abs(run.best_cost());
    before = run.best_cost();
    const std::string how =
        fmt::format("{}, start {} gained {:.2g}", in_words(code, options_), round + 1, gain);
    if (slope <= options_.gradient_tolerance)
      return {Termination::Settled, fmt::format("projected gradient {:.2g} <= {:.2g} of the cost ({})", slope,
                                                options_.gradient_tolerance, how)};
    if (round >= options_.restarts || (round > 0 && gain <= options_.restart_gain)) return ended(code, how);
    objective.set_scale(run.best_cost());
  }
}

std::vector<SolverEntry> nlopt_entries() {
  std::vector<SolverEntry> entries;
  for (const NloptAlgorithm& row : nlopt_algorithms()) {
    NloptOptions defaults;
    defaults.algorithm = &row;
    if (row.gradient && !row.global) defaults.evaluations = 10000;
    if (row.global) defaults.ftol = 0;            // one generation without progress is no reason to stop
    if (row.local) defaults.evaluations = 20000;  // its own work grows with their square
    if (row.scalar_step) defaults.step = 0.25;
    defaults.memory = 100;
    entries.push_back(
        make_entry<NloptSolver, NloptOptions>("nlopt:" + row.name, row.summary, row.stochastic, defaults));
  }
  return entries;
}

}  // namespace odobench
