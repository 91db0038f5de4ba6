#include "solvers/levenberg_marquardt.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <stdexcept>

#include "solvers/optimality.hpp"

namespace odobench {

Vector solve_box_quadratic(const Matrix& h, const Vector& g, const Vector& lower, const Vector& upper) {
  const Eigen::Index m = g.size();
  enum class At { Free, Lower, Upper };
  std::vector<At> state(static_cast<std::size_t>(m), At::Free);
  const auto at = [&](Eigen::Index i) -> At& { return state[static_cast<std::size_t>(i)]; };
  Vector d = Vector::Zero(m);
  for (Eigen::Index i = 0; i < m; ++i) {  // begin on the bounds that steepest descent would leave through
    if (lower[i] >= 0 && g[i] > 0) at(i) = At::Lower;
    if (upper[i] <= 0 && g[i] < 0) at(i) = At::Upper;
  }
  for (Eigen::Index change = 0; change < 50 * m; ++change) {
    std::vector<Eigen::Index> free;
    for (Eigen::Index i = 0; i < m; ++i)
      if (at(i) == At::Free) free.push_back(i);
    const Vector gradient = g + h * d;
    Vector step = Vector::Zero(m);
    if (!free.empty()) {
      const Matrix hf = h(free, free);
      const Vector gf = gradient(free);
      step(free) = -Eigen::LDLT<Matrix>(hf).solve(gf);
    }
    double length = 1.0;
    Eigen::Index blocking = -1;
    for (Eigen::Index i : free) {
      const double room = step[i] < 0 ? lower[i] - d[i] : upper[i] - d[i];
      if (step[i] != 0 && room / step[i] < length) {
        length = std::max(0.0, room / step[i]);
        blocking = i;
      }
    }
    d += length * step;
    if (blocking >= 0) {
      at(blocking) = step[blocking] < 0 ? At::Lower : At::Upper;
      d[blocking] = step[blocking] < 0 ? lower[blocking] : upper[blocking];
      continue;
    }
    // Minimum on the free subspace: release the bound whose multiplier has the wrong sign most, or be done.
    const Vector reduced = g + h * d;
    Eigen::Index worst = -1;
    double worst_value = 0;
    for (Eigen::Index i = 0; i < m; ++i) {
      if (at(i) == At::Free || lower[i] == upper[i]) continue;
      const double wrong = (at(i) == At::Lower ? -reduced[i] : reduced[i]) / std::sqrt(h(i, i));
      if (wrong > worst_value) {
        worst_value = wrong;
        worst = i;
      }
    }
    const double scale = 1e-14 * (reduced.array().abs() / h.diagonal().array().sqrt()).maxCoeff();
    if (worst < 0 || worst_value <= scale) break;
    at(worst) = At::Free;
  }
  return d;
}

void LevenbergMarquardtOptions::bind(OptionBinder& binder) {
  binder.number("lambda", lambda, "initial damping, relative to the diagonal of J'J", 1e-12, 1e12);
  binder.number("gradient_tolerance", gradient_tolerance,
                "stop when every free |J'r|_i / (|J_i| |r|) is at most this", 0, 1);
  binder.number("cost_tolerance", cost_tolerance,
                "stop when the predicted decrease is at most this times the cost", 0, 1);
  binder.integer("iterations", iterations, "iteration limit", 1);
}

void LevenbergMarquardtOptions::validate() const {}

std::string LevenbergMarquardt::why_not(const Problem& problem) const {
  return problem.has_normal_equations() ? "" : "needs residuals with a Jacobian, the problem has none";
}

Outcome LevenbergMarquardt::minimise(Run& run) const {
  const Eigen::Index m = run.dimension();
  Vector u = run.start();
  NormalEquations e;
  if (!std::isfinite(run.normal_equations(u, e)))
    return {Termination::Failed, "the cost at the start is not finite"};
  double lambda = options_.lambda;
  double growth = 2;
  for (int k = 0; k < options_.iterations; ++k) {
    if (e.cost == 0) return {Termination::Converged, "cost 0: an exact fit"};
    const double projected = projected_cosine(u, e);
    if (projected <= options_.gradient_tolerance)
      return {Termination::Converged, fmt::format("projected gradient {:.2g} <= {:.2g} (relative)", projected,
                                                  options_.gradient_tolerance)};

    Vector damping = e.jtj.diagonal();
    const double smallest = 1e-16 * std::max(damping.maxCoeff(), std::numeric_limits<double>::min());
    damping = damping.cwiseMax(smallest);
    Matrix h = e.jtj;
    h.diagonal() += lambda * damping;
    const Vector d =
        solve_box_quadratic(h, e.jtr, Vector::Constant(m, -1.0) - u, Vector::Constant(m, 1.0) - u);
    const double predicted = -(2.0 * e.jtr.dot(d) + d.dot(e.jtj * d));
    if (!(predicted > options_.cost_tolerance * e.cost))
      return {Termination::Converged, fmt::format("predicted decrease {:.2g} <= {:.2g} times the cost",
                                                  predicted / e.cost, options_.cost_tolerance)};
    const Vector candidate = (u + d).cwiseMax(-1.0).cwiseMin(1.0);
    const double cost = run.cost(candidate);
    if (run.stop()) return {};
    run.iteration();
    const double rho = (e.cost - cost) / predicted;
    if (cost < e.cost) {
      u = candidate;
      run.normal_equations(u, e);
      if (run.stop()) return {};
      lambda *= std::max(1.0 / 3.0, 1.0 - std::pow(2.0 * rho - 1.0, 3));
      lambda = std::max(lambda, 1e-14);
      growth = 2;
    } else {
      lambda *= growth;
      growth *= 2;
      if (lambda > 1e20)
        return {Termination::Stalled,
                fmt::format("damping {:.2g} > 1e20, projected gradient {:.2g}", lambda, projected)};
    }
  }
  return {Termination::IterationLimit,
          fmt::format("{} iterations >= limit {}", options_.iterations, options_.iterations)};
}

SolverEntry levenberg_marquardt_entry() {
  return make_entry<LevenbergMarquardt, LevenbergMarquardtOptions>(
      "lm", "Levenberg-Marquardt whose step solves the box-constrained quadratic model", false);
}

}  // namespace odobench
