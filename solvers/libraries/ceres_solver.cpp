#include "solvers/libraries/ceres_solver.hpp"

#include <ceres/ceres.h>
#include <fmt/format.h>
#include <glog/logging.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <exception>
#include <mutex>

#include "solvers/certificate/optimality.hpp"

namespace odobench {
namespace {

constexpr double kHardlyDamped = 1e8;  // a trust-region radius

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Ceres writes warnings about rejected steps to the standard error through glog, whatever its own logging
// options say. glog has only a process-wide switch; nothing but Ceres uses it here.
void silence_glog() {
  static std::once_flag once;
  std::call_once(once, [] { FLAGS_minloglevel = google::GLOG_FATAL; });
}

// What the cost function shares with the iteration callback and the outer loop: the point, which of its
// coordinates are free, the derivatives last evaluated, as Ceres gets them, and where.
struct Workspace {
  Run& run;
  bool full = false;
  double scale =
      1;  // residuals are multiplied with it, so that Ceres' absolute thresholds see a cost of about 1
  Vector u;
  std::vector<Eigen::Index> free;
  NormalEquations e;
  Matrix jacobian;
  Vector residuals;
  Vector e_at;
  std::exception_ptr error;

  Eigen::Index rows() const { return full ? run.problem().residual_count() : run.dimension() + 1; }
  // Evaluates at p unless that was done last; false where cost or derivatives are not finite or the driver
  // says stop.
  bool differentiate(const Vector& p);

  Vector point(const double* x) const {
    Vector p = u;
    for (std::size_t k = 0; k < free.size(); ++k) p[free[k]] = x[k];
    return p;
  }
  bool has_derivatives_at(const Vector& p) const {
    return e_at.size() == p.size() && (e_at.array() == p.array()).all();
  }
};

bool Workspace::differentiate(const Vector& p) {
  if (has_derivatives_at(p)) return true;
  e_at.resize(0);
  if (full || run.problem().forms_normal_equations()) {
    Matrix j(run.problem().residual_count(), p.size());
    Vector r(j.rows());
    const double cost = run.residuals_and_jacobian(p, r, j);
    if (!std::isfinite(cost)) return false;
    e = {cost, j.transpose() * r, j.transpose() * j};
    if (full) {
      jacobian = std::move(j);
      residuals = std::move(r);
    } else {
      compress_residuals(j, r, jacobian, residuals);
    }
  } else {
    if (!std::isfinite(run.normal_equations(p, e))) return false;
    compress_residuals(e, jacobian, residuals);
  }
  e_at = p;
  return true;
}

// Sum of squares for Ceres on the free coordinates. Where only the cost is asked for, one residual carries it
// all: Ceres then looks at nothing but the norm.
class Residuals final : public ceres::CostFunction {
 public:
  explicit Residuals(Workspace& work) : work_(work) {
    set_num_residuals(static_cast<int>(work.rows()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(work.free.size()));
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    if (work_.error) return false;
    try {
      return evaluate(work_.point(parameters[0]), residuals, jacobians == nullptr ? nullptr : jacobians[0]);
    } catch (...) {  // not through Ceres' frames; the outer loop throws it on
      work_.error = std::current_exception();
      return false;
    }
  }

 private:
  bool evaluate(const Vector& u, double* residuals, double* jacobian) const {
    Eigen::Map<Vector> out(residuals, num_residuals());
    if (jacobian == nullptr) {
      const double cost = work_.has_derivatives_at(u) ? work_.e.cost : work_.run.cost(u);
      if (!std::isfinite(cost) || work_.run.stop()) return false;
      out.setZero();
      out[0] = work_.scale * std::sqrt(cost);
      return true;
    }
    if (!work_.differentiate(u)) return false;
    out = work_.scale * work_.residuals;
    const auto columns = static_cast<Eigen::Index>(work_.free.size());
    Eigen::Map<RowMajor>(jacobian, num_residuals(), columns) =
        work_.scale * work_.jacobian(Eigen::all, work_.free);
    return true;
  }

  Workspace& work_;
};

// Ends a round when the driver says stop, when the KKT conditions hold, or when a free coordinate has arrived
// at a bound that should hold it: from there on Ceres' projected steps only creep.
class RoundControl final : public ceres::IterationCallback {
 public:
  RoundControl(Workspace& work, const std::vector<double>& x, const CeresOptions& options)
      : work_(work), x_(x), options_(options) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    if (work_.error || work_.run.stop()) return ceres::SOLVER_ABORT;
    if (summary.iteration > 0) {
      work_.run.iteration();
      ++iterations_;
    }
    const Vector u = work_.point(x_.data());
    if (!summary.step_is_successful || !work_.has_derivatives_at(u)) return ceres::SOLVER_CONTINUE;
    if (projected_cosine(u, work_.e) <= options_.gradient_tolerance)
      return ceres::SOLVER_TERMINATE_SUCCESSFULLY;
    if (!options_.active_set) return ceres::SOLVER_CONTINUE;
    for (Eigen::Index i : work_.free) arrived_ = arrived_ || held_by_bound(u[i], work_.e.jtr[i]);
    return arrived_ ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }
  bool arrived() const { return arrived_; }
  int iterations() const { return iterations_; }

 private:
  Workspace& work_;
  const std::vector<double>& x_;
  const CeresOptions& options_;
  bool arrived_ = false;
  int iterations_ = 0;
};

struct Round {
  bool arrived = false;  // ended early at a bound
  int iterations = 0;
  std::string message;
};

// One call of Ceres on the free coordinates of work.u, which receives the result.
Round solve_free(Workspace& work, const CeresOptions& options, double radius, int iterations) {
  std::vector<double> x;
  for (Eigen::Index i : work.free) x.push_back(work.u[i]);
  Residuals residuals(work);
  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  problem.AddResidualBlock(&residuals, nullptr, x.data());
  for (int k = 0; k < static_cast<int>(x.size()); ++k) {
    problem.SetParameterLowerBound(x.data(), k, -1.0);
    problem.SetParameterUpperBound(x.data(), k, 1.0);
  }
  RoundControl control(work, x, options);
  ceres::Solver::Options settings;
  settings.trust_region_strategy_type = options.strategy == "lm" ? ceres::LEVENBERG_MARQUARDT : ceres::DOGLEG;
  settings.linear_solver_type = ceres::DENSE_QR;
  settings.dense_linear_algebra_library_type = ceres::EIGEN;
  settings.initial_trust_region_radius = radius;
  settings.max_num_iterations = iterations;
  settings.function_tolerance = options.cost_tolerance;
  settings.gradient_tolerance = 0;  // absolute in Ceres; RoundControl has one that does not depend on scale
  settings.parameter_tolerance = 0;
  settings.num_threads = 1;
  settings.logging_type = ceres::SILENT;
  settings.minimizer_progress_to_stdout = false;
  settings.update_state_every_iteration = true;
  settings.callbacks.push_back(&control);
  ceres::Solver::Summary summary;
  ceres::Solve(settings, &problem, &summary);
  if (work.error) std::rethrow_exception(work.error);
  work.u = work.point(x.data());  // the last accepted point, also when Ceres gave up
  return {control.arrived(), control.iterations(), summary.message};
}

// Adds the coordinates that their bounds hold; `release` first frees all.
void update_free(Workspace& work, bool release) {
  std::vector<Eigen::Index> free;
  for (Eigen::Index i = 0; i < work.u.size(); ++i) {
    const bool candidate = release || std::find(work.free.begin(), work.free.end(), i) != work.free.end();
    if (candidate && !held_by_bound(work.u[i], work.e.jtr[i])) free.push_back(i);
  }
  work.free = std::move(free);
}

// Derivatives at work.u; false when the driver says stop, or when they are not finite there.
bool refresh(Workspace& work) {
  return !work.run.stop() && work.differentiate(work.u) && !work.run.stop();
}

// Why refresh() did not work: the driver's reason replaces this one where it is the driver's.
Outcome broken(const Workspace& work) {
  if (work.run.stop_reason() != Termination::NotStarted) return {};
  return {Termination::Stalled, "the derivatives at the last accepted point are not finite"};
}

Outcome settled(double cosine, const CeresOptions& options, int round) {
  return {Termination::Settled, fmt::format("projected gradient {:.2g} <= {:.2g} (relative) in round {}",
                                            cosine, options.gradient_tolerance, round)};
}

// A round ended without meeting the gradient tolerance.
Outcome no_progress(const std::string& how, double cosine) {
  return {Termination::Stalled, fmt::format("{}, projected gradient {:.2g}", how, cosine)};
}

// Ceres as it comes.
Outcome single_round(Workspace& work, const CeresOptions& options) {
  for (Eigen::Index i = 0; i < work.u.size(); ++i) work.free.push_back(i);
  const Round result = solve_free(work, options, options.radius, options.iterations);
  if (!refresh(work)) return broken(work);
  const double cosine = projected_cosine(work.u, work.e);
  if (cosine <= options.gradient_tolerance) return settled(cosine, options, 1);
  if (result.iterations >= options.iterations)
    return {Termination::IterationLimit,
            fmt::format("{} iterations >= limit {}", result.iterations, options.iterations)};
  return no_progress("Ceres says: " + result.message, cosine);
}

Outcome active_set_rounds(Workspace& work, const CeresOptions& options) {
  int left = options.iterations;
  bool release = true;
  double radius = options.radius;
  double last_cost = std::numeric_limits<double>::infinity();
  for (int round = 1;; ++round) {
    if (work.e.cost == 0) return {Termination::Settled, "cost 0: an exact fit"};
    const double cosine = projected_cosine(work.u, work.e);
    if (cosine <= options.gradient_tolerance) return settled(cosine, options, round);
    const auto previous = work.free;
    update_free(work, release);
    if (release && previous == work.free && !(last_cost - work.e.cost > options.cost_tolerance * work.e.cost))
      return no_progress(fmt::format("round {} gained nothing", round - 1), cosine);
    if (left <= 0)
      return {Termination::IterationLimit,
              fmt::format("{} iterations >= limit {}", options.iterations, options.iterations)};
    last_cost = work.e.cost;
    if (work.free.empty()) {  // everything is held, but not every multiplier has its sign
      release = true;
      continue;
    }
    const Round result = solve_free(work, options, radius, std::min(left, options.round_iterations));
    if (!refresh(work)) return broken(work);
    left -= std::max(1, result.iterations);
    // Ceres scales its damping by the present columns of J: where they shrink fast it creeps, and hardly
    // damped steps get on.
    if (result.iterations >= options.round_iterations)
      radius = radius == options.radius ? kHardlyDamped : options.radius;
    release = !result.arrived;
  }
}

}  // namespace

void compress_residuals(const Matrix& j, const Vector& r, Matrix& jacobian, Vector& residuals) {
  const Eigen::Index m = j.cols(), rows = std::min(j.rows(), m + 1);
  Matrix both(j.rows(), m + 1);
  both << j, r;
  const Eigen::HouseholderQR<Matrix> qr(std::move(both));
  Matrix factor = Matrix::Zero(m + 1, m + 1);
  factor.topRows(rows) = qr.matrixQR().topRows(rows).triangularView<Eigen::Upper>();
  jacobian = factor.leftCols(m);
  residuals = factor.col(m);
}

void compress_residuals(const NormalEquations& e, Matrix& jacobian, Vector& residuals) {
  const Eigen::Index m = e.jtr.size();
  Matrix gram(m + 1, m + 1);
  gram << e.jtj, e.jtr, e.jtr.transpose(), e.cost;
  // A unit diagonal first: the factor then does not depend on units.
  const Vector size = gram.diagonal().cwiseMax(0.0).cwiseSqrt();
  const Vector inverse = (size.array() > 0).select(1.0 / size.array(), 0.0);
  gram = inverse.asDiagonal() * gram * inverse.asDiagonal();
  const Eigen::LDLT<Matrix> ldlt(gram);
  const Vector root = ldlt.vectorD().cwiseMax(0.0).cwiseSqrt();
  // A = P'L D L'P. Eigen applies transpositions from the right in the opposite order, hence from the left.
  const Matrix lower = Matrix(ldlt.matrixL()) * root.asDiagonal();
  const Matrix permuted = ldlt.transpositionsP().transpose() * lower;
  const Matrix factor = permuted.transpose() * size.asDiagonal();
  jacobian = factor.leftCols(m);
  residuals = factor.col(m);
}

void CeresOptions::bind(OptionBinder& binder) {
  binder.choice("strategy", strategy, "trust-region strategy", {"lm", "dogleg"});
  binder.flag(
      "active_set", active_set,
      "hold parameters at their bounds by the sign of their multiplier (false: Ceres alone, which stalls)");
  binder.choice("residuals", residuals,
                "rows given to Ceres: the square root of the normal equations, or all",
                {"compressed", "full"});
  binder.number("radius", radius, "initial trust-region radius", 1e-12, 1e16);
  binder.number("gradient_tolerance", gradient_tolerance,
                "stop when every free |J'r|_i / (|J_i| |r|) is at most this", 0, 1);
  binder.number("cost_tolerance", cost_tolerance,
                "a round ends when the cost decreases by at most this times itself", 0, 1);
  binder.integer("iterations", iterations, "iteration limit over all rounds", 1);
  binder.integer(
      "round_iterations", round_iterations,
      "a round this long is broken off, and the next begins hardly damped (radius 1e8), or with radius again",
      1);
}

std::string CeresSolver::why_not(const Problem& problem) const {
  if (options_.residuals == "full")
    return problem.has_residuals() ? ""
                                   : "residuals=full needs residuals with a Jacobian, the problem has none";
  return problem.has_normal_equations() ? "" : "needs residuals with a Jacobian, the problem has none";
}

Outcome CeresSolver::minimise(Run& run) const {
  silence_glog();
  Workspace work{run, options_.residuals == "full", 1.0, run.start(), {}, {}, {}, {}, {}, {}};
  if (!work.differentiate(work.u)) {
    if (run.stop()) return {};
    return {Termination::Failed, "the cost or its derivatives at the start are not finite"};
  }
  if (work.e.cost == 0) return {Termination::Settled, "cost 0: an exact fit"};
  work.scale = 1.0 / std::sqrt(work.e.cost);
  return options_.active_set ? active_set_rounds(work, options_) : single_round(work, options_);
}

SolverEntry ceres_entry() {
  return make_entry<CeresSolver, CeresOptions>(
      "ceres", "Ceres 2.1 trust region with bounds inside an active-set loop", false);
}

}  // namespace odobench
