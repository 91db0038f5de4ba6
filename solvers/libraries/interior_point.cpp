#include "solvers/libraries/interior_point.hpp"

#include <fmt/format.h>
#include <IpIpoptApplication.hpp>
#include <IpTNLP.hpp>

#include <cmath>
#include <exception>
#include <mutex>

#include "solvers/certificate/optimality.hpp"
#include "solvers/certificate/verdict.hpp"

namespace odobench {
namespace {

std::mutex& ipopt_mutex() {
  static std::mutex mutex;
  return mutex;
}

// A sum of squares cannot fall below zero, nor below what the problem itself states as rounding.
bool exact_fit(const Run& run) {
  if (!run.has_best() || !run.problem().has_normal_equations()) return false;
  return run.best_cost() == 0 || run.best_cost() <= run.problem().rounding_floor(run.best_parameters());
}

// Leaves Ipopt's code for the duration of a call-back. Declared before anything whose destruction could
// throw.
class Outside {
 public:
  explicit Outside(std::unique_lock<std::mutex>& lock) : lock_(lock) { lock_.unlock(); }
  ~Outside() { lock_.lock(); }
  Outside(const Outside&) = delete;
  Outside& operator=(const Outside&) = delete;

 private:
  std::unique_lock<std::mutex>& lock_;
};

// Ipopt asks for cost, gradient and Hessian of a point one by one: cost(u) is kept, and one derivative call
// serves gradient and Hessian.
class BoxProgram final : public Ipopt::TNLP {
 public:
  using Index = Ipopt::Index;
  using Number = Ipopt::Number;

  BoxProgram(Run& run, const InteriorPointOptions& options, Vector start, double scale,
             std::unique_lock<std::mutex>& lock)
      : run_(run),
        start_(std::move(start)),
        gauss_newton_(options.hessian != "lbfgs"),
        corrected_(options.hessian == "corrected"),
        scale_(scale),
        lock_(lock) {}

  bool get_nlp_info(Index& n, Index& m, Index& jacobian, Index& hessian, IndexStyleEnum& style) override {
    n = static_cast<Index>(run_.dimension());
    m = 0;
    jacobian = 0;
    hessian = n * (n + 1) / 2;
    style = C_STYLE;
    return true;
  }
  bool get_bounds_info(Index n, Number* lower, Number* upper, Index, Number*, Number*) override {
    std::fill(lower, lower + n, -1.0);
    std::fill(upper, upper + n, 1.0);
    return true;
  }
  bool get_starting_point(Index n, bool, Number* x, bool, Number*, Number*, Index, bool, Number*) override {
    std::copy(start_.data(), start_.data() + n, x);
    return true;
  }

  bool eval_f(Index n, const Number* x, bool, Number& value) override {
    const Vector u = Eigen::Map<const Vector>(x, n);
    if (same(u, derivatives_at_))
      value = scale_ * e_.cost;
    else
      value = scale_ * guarded([&] { return run_.cost(u); });
    return std::isfinite(value) && !error_;
  }
  bool eval_grad_f(Index n, const Number* x, bool, Number* gradient) override {
    if (!derivatives(Eigen::Map<const Vector>(x, n))) return false;
    Eigen::Map<Vector>(gradient, n) = 2.0 * scale_ * e_.jtr;
    return true;
  }
  bool eval_g(Index, const Number*, bool, Index, Number*) override { return true; }
  bool eval_jac_g(Index, const Number*, bool, Index, Index, Index*, Index*, Number*) override { return true; }
  bool eval_h(Index n, const Number* x, bool, Number factor, Index, const Number*, bool, Index, Index* rows,
              Index* columns, Number* values) override {
    if (values != nullptr && !derivatives(Eigen::Map<const Vector>(x, n))) return false;
    if (values != nullptr && corrected_) correct();
    Index k = 0;
    for (Index i = 0; i < n; ++i)
      for (Index j = 0; j <= i; ++j, ++k) {
        if (values == nullptr) {
          rows[k] = i;
          columns[k] = j;
        } else {
          values[k] = 2.0 * scale_ * factor * (e_.jtj(i, j) + (corrected_ ? correction_(i, j) : 0.0));
        }
      }
    return true;
  }
  void finalize_solution(Ipopt::SolverReturn, Index n, const Number* x, const Number*, const Number*, Index,
                         const Number*, const Number*, Number, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {
    last_ = Eigen::Map<const Vector>(x, n);
  }
  bool intermediate_callback(Ipopt::AlgorithmMode, Index iteration, Number, Number, Number dual_infeasibility,
                             Number mu, Number, Number, Number, Number, Index, const Ipopt::IpoptData*,
                             Ipopt::IpoptCalculatedQuantities*) override {
    iterations_ = iteration;
    dual_infeasibility_ = dual_infeasibility;
    mu_ = mu;
    guarded([&] {
      if (iteration > 0) run_.iteration();
      return 0.0;
    });
    return !error_ && !run_.stop() && !exact_fit(run_);
  }

  // Half the gradient, by normal equations or by a gradient; kept for the next request at the same point.
  bool derivatives(const Vector& u) {
    if (same(u, derivatives_at_)) return true;
    derivatives_at_.resize(0);
    guarded([&] {
      if (gauss_newton_) return run_.normal_equations(u, e_);
      e_.jtr.resize(u.size());
      e_.cost = run_.cost_and_gradient(u, e_.jtr);
      e_.jtr *= 0.5;
      return e_.cost;
    });
    if (error_ || !std::isfinite(e_.cost) || run_.stop()) return false;
    derivatives_at_ = u;
    return true;
  }

  const NormalEquations& equations() const { return e_; }
  const Vector& last() const { return last_; }
  Index iterations() const { return iterations_; }
  double dual_infeasibility() const { return dual_infeasibility_; }
  double mu() const { return mu_; }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  // Secant estimate S of the part of half the Hessian that J'J leaves out, sum r_i (second derivatives of
  // r_i), after Dennis, Gay, Welsch 1981 (NL2SOL): S is sized, then receives a symmetric rank-one update, so
  // that S s = y, s the last step, y = change of J'r minus J'J s.
  void correct() {
    const Eigen::Index m = derivatives_at_.size();
    if (correction_.size() == 0) correction_ = Matrix::Zero(m, m);
    if (same(derivatives_at_, corrected_at_)) return;
    if (corrected_at_.size() == m) {
      const Vector s = derivatives_at_ - corrected_at_;
      const Vector y = e_.jtr - corrected_jtr_ - e_.jtj * s;
      const double now = s.dot(correction_ * s);
      if (now != 0) correction_ *= std::min(1.0, std::abs(s.dot(y) / now));
      const Vector miss = y - correction_ * s;
      const double denominator = miss.dot(s);
      if (std::abs(denominator) > 1e-8 * miss.norm() * s.norm())
        correction_ += miss * miss.transpose() / denominator;
    }
    corrected_at_ = derivatives_at_;
    corrected_jtr_ = e_.jtr;
  }

  static bool same(const Vector& a, const Vector& b) {
    return a.size() == b.size() && (a.array() == b.array()).all();
  }

  // Runs f outside the mutex; an exception is kept for rethrow(), since it must not pass through Ipopt.
  template <class F>
  double guarded(const F& f) {
    const Outside outside(lock_);
    if (error_) return std::numeric_limits<double>::infinity();
    try {
      return f();
    } catch (...) {
      error_ = std::current_exception();
      return std::numeric_limits<double>::infinity();
    }
  }

  Run& run_;
  Vector start_;
  bool gauss_newton_, corrected_;
  double scale_;
  std::unique_lock<std::mutex>& lock_;
  NormalEquations e_;
  Vector derivatives_at_, last_;
  Matrix correction_;
  Vector corrected_at_, corrected_jtr_;
  Index iterations_ = 0;
  double dual_infeasibility_ = 0, mu_ = 0;
  std::exception_ptr error_;
};

// `again`: a further start, from the end of another; it stays there instead of stepping back to the middle of
// the box.
void set_options(Ipopt::OptionsList& list, const InteriorPointOptions& options, bool again) {
  list.SetStringValue("sb", "yes");
  list.SetIntegerValue("print_level", 0);
  list.SetStringValue("option_file_name", "");
  list.SetNumericValue("bound_relax_factor", 0);
  list.SetStringValue("mu_strategy", again ? "monotone" : options.mu_strategy);
  if (again) {
    list.SetNumericValue("mu_init", 1e-9);
    list.SetNumericValue("bound_push", 1e-9);
    list.SetNumericValue("bound_frac", 1e-9);
  }
  // MUMPS 5.5 counts what it would save of itself at every call, which takes longer than solving a dozen
  // equations.
  list.SetIntegerValue("min_refinement_steps", 0);
  list.SetStringValue("nlp_scaling_method", options.nlp_scaling);
  list.SetNumericValue("tol", options.tolerance);
  list.SetNumericValue("dual_inf_tol", options.tolerance);
  list.SetNumericValue("compl_inf_tol", options.tolerance);
  list.SetIntegerValue("acceptable_iter", 0);
  list.SetIntegerValue("max_iter", options.iterations);
  list.SetStringValue("hessian_approximation", options.hessian == "lbfgs" ? "limited-memory" : "exact");
  list.SetIntegerValue("limited_memory_max_history", options.memory);
  list.SetStringValue("linear_solver", "mumps");
}

Outcome outcome_of(Ipopt::ApplicationReturnStatus status, const BoxProgram& program,
                   const InteriorPointOptions& options) {
  const std::string numbers =
      fmt::format("dual infeasibility {:.2g}, barrier parameter {:.2g}, {} iterations",
                  program.dual_infeasibility(), program.mu(), program.iterations());
  switch (status) {
    case Ipopt::Solve_Succeeded:
      return {Termination::Settled,
              fmt::format("Ipopt: KKT error <= {:.2g}; {}", options.tolerance, numbers)};
    case Ipopt::Solved_To_Acceptable_Level:
    case Ipopt::Search_Direction_Becomes_Too_Small:
      return {Termination::Stalled, "Ipopt: the step is too small; " + numbers};
    case Ipopt::Restoration_Failed:
      return {Termination::Stalled, "Ipopt: no step lowers the cost; " + numbers};
    case Ipopt::Maximum_Iterations_Exceeded:
      return {Termination::IterationLimit,
              fmt::format("{} iterations >= limit {}", program.iterations(), options.iterations)};
    case Ipopt::Invalid_Number_Detected:
      return {Termination::Failed, "Ipopt: the cost or its derivatives are not finite; " + numbers};
    default:
      return {Termination::Failed,
              fmt::format("Ipopt: return status {}; {}", static_cast<int>(status), numbers)};
  }
}

// One call of Ipopt, from the start of the run or from its best point, with the cost there as unit;
// `iterations` counts on.
Outcome start_once(Run& run, InteriorPointOptions options, int& iterations, bool again) {
  options.iterations -= iterations;
  std::unique_lock<std::mutex> lock(ipopt_mutex());
  const Ipopt::SmartPtr<BoxProgram> program =
      new BoxProgram(run, options, again ? run.best() : run.start(), 1.0 / std::abs(run.best_cost()), lock);
  Ipopt::ApplicationReturnStatus status = Ipopt::Internal_Error;
  {
    const Ipopt::SmartPtr<Ipopt::IpoptApplication> application = new Ipopt::IpoptApplication(false);
    set_options(*application->Options(), options, again);
    status = application->Initialize("");  // no file name: no ipopt.opt is read
    if (status == Ipopt::Solve_Succeeded)
      status = application->OptimizeTNLP(Ipopt::SmartPtr<Ipopt::TNLP>(GetRawPtr(program)));
  }
  program->rethrow();
  iterations += program->iterations();
  if (run.stop()) return {};
  const Outcome outcome = outcome_of(status, *program, options);
  if (program->last().size() > 0 && program->derivatives(program->last())) {
    const Vector snapped = put_on_bounds(program->last(), program->equations().jtr, 1e-4);
    lock.unlock();
    if (snapped != program->last()) run.cost(snapped);
    lock.lock();
  }
  return outcome;
}

// A bounded step from the best point promises more than this part of the cost: by normal equations, one
// evaluation.
bool promising(Run& run, double part) {
  NormalEquations e;
  if (!run.problem().has_normal_equations() || !std::isfinite(run.normal_equations(run.best(), e)))
    return false;
  return bounded_promise(run.best(), e) > part;
}

}  // namespace

void InteriorPointOptions::bind(OptionBinder& binder) {
  binder.choice("hessian", hessian,
                "second derivatives: 2 (J'J + secant correction), 2 J'J, or limited-memory BFGS (needs only "
                "a gradient)",
                {"corrected", "gauss-newton", "lbfgs"});
  binder.integer("memory", memory, "pairs kept by hessian=lbfgs", 1, 1000);
  binder.choice("mu_strategy", mu_strategy, "update of the barrier parameter", {"adaptive", "monotone"});
  binder.choice("nlp_scaling", nlp_scaling, "Ipopt's own scaling of the cost", {"none", "gradient-based"});
  binder.number("tolerance", tolerance, "KKT error of the cost relative to its start at which to stop", 1e-16,
                1);
  binder.integer("iterations", iterations, "iteration limit", 1);
  binder.integer("restarts", restarts, "further starts from the best point while they gain", 0, 1000);
  binder.number("restart_gain", restart_gain,
                "relative gain, had or promised, below which there is no further one", 0, 1);
}

std::string InteriorPoint::why_not(const Problem& problem) const {
  if (options_.hessian == "lbfgs")
    return problem.has_gradient() ? "" : "needs a gradient, the problem has none";
  if (problem.has_normal_equations()) return "";
  return problem.has_gradient() ? fmt::format(
                                      "hessian={} needs residuals with a Jacobian, the problem has only a "
                                      "gradient: use hessian=lbfgs",
                                      options_.hessian)
                                : "needs residuals with a Jacobian, the problem has none";
}

Outcome InteriorPoint::minimise(Run& run) const {
  const double cost = run.cost(run.start());
  if (run.stop()) return {};
  if (!std::isfinite(cost)) return {Termination::Failed, "the cost at the start is not finite"};
  if (cost == 0) return {Termination::Settled, "cost 0 at the start"};

  Outcome outcome;
  int iterations = 0;
  for (int start = 0;; ++start) {
    const double before = run.best_cost();
    const Outcome ended = start_once(run, options_, iterations, start > 0);
    if (run.stop()) return {};
    if (exact_fit(run))
      return {Termination::Settled,
              fmt::format("cost {:.2g}: an exact fit, as far as rounding lets it be", run.best_cost())};
    // What Ipopt has reached once stays reached when a further start breaks down.
    if (start == 0 || ended.termination != Termination::Failed) outcome = ended;
    if (ended.termination == Termination::Failed || before == 0) return outcome;
    const double gain = (before - run.best_cost()) / before;
    if (start >= options_.restarts || iterations >= options_.iterations ||
        (start > 0 && gain <= options_.restart_gain) || !promising(run, options_.restart_gain))
      return outcome;
  }
}

SolverEntry interior_point_entry() {
  return make_entry<InteriorPoint, InteriorPointOptions>(
      "ip", "interior point (Ipopt 3.11) with Gauss-Newton or L-BFGS Hessian", false);
}

}  // namespace odobench
