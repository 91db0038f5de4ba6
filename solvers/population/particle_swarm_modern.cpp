#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "solvers/box/boundary_map.hpp"
#include "solvers/population/particle_swarm.hpp"

namespace odobench {
namespace {

constexpr double kInertiaRate = 0.05, kInertiaAim = 0.4, kInertiaLowest = 0.3, kInertiaHighest = 0.8;  // (M2)

// Eigenvectors of the covariance of the personal bests.
Matrix memory_frame(const Matrix& best) {
  const Vector mean = best.rowwise().mean();
  const Matrix centred = best.colwise() - mean;
  return Eigen::SelfAdjointEigenSolver<Matrix>(Matrix(centred * centred.transpose())).eigenvectors();
}

// Whom every particle hears of.
using Links = std::vector<std::vector<Eigen::Index>>;
Links draw_links(Random& random, Eigen::Index size, int informants) {
  Links links(static_cast<std::size_t>(size));
  for (auto& list : links)
    for (int i = 0; i < informants; ++i) list.push_back(random.integer(0, size - 1));
  return links;
}

struct Coefficients {
  double w, c1, c2, reach;
};

// (M1) for all particles.
void move(Swarm& s, const Links& links, const Coefficients& c, Random& random) {
  const Matrix b = memory_frame(s.best);
  const Eigen::Index m = s.x.rows();
  for (Eigen::Index k = 0; k < s.x.cols(); ++k) {
    Eigen::Index informant = k;
    for (Eigen::Index j : links[static_cast<std::size_t>(k)])
      if (s.best_costs[j] < s.best_costs[informant]) informant = j;
    const Vector own = b.transpose() * (s.best.col(k) - s.x.col(k));
    const Vector other = b.transpose() * (s.best.col(informant) - s.x.col(k));
    Vector pull(m);
    for (Eigen::Index i = 0; i < m; ++i) {
      const double u1 = random.uniform();
      const double u2 = random.uniform();
      pull[i] = c.c1 * u1 * own[i] + c.c2 * u2 * other[i];
    }
    s.v.col(k) = c.w * s.v.col(k) + b * pull;
    s.x.col(k) += s.v.col(k);
    for (Eigen::Index i = 0; i < m; ++i) {
      if (std::abs(s.x(i, k)) <= c.reach) continue;
      s.x(i, k) = std::copysign(c.reach, s.x(i, k));
      s.v(i, k) = 0;
    }
  }
}

Swarm start_swarm(Run& run, Eigen::Index size, const BoundaryMap& map) {
  const Eigen::Index m = run.dimension();
  const double reach = map.reach();
  Swarm s{Matrix(m, size), Matrix(m, size), {}, Vector(size)};
  for (double& y : s.x.reshaped()) y = run.random().uniform(-reach, reach);
  s.x.col(0) = map.from_box(run.start());
  for (Eigen::Index k = 0; k < size; ++k)  // half the way to another random point, as in Standard PSO 2007
    for (Eigen::Index i = 0; i < m; ++i) s.v(i, k) = 0.5 * (run.random().uniform(-reach, reach) - s.x(i, k));
  s.best = s.x;
  run.batch_cost(map.to_box(s.x), s.best_costs);
  return s;
}

}  // namespace

Outcome minimise_swarm_modern(Run& run, const ParticleSwarmOptions& options) {
  const Eigen::Index m = run.dimension();
  const Eigen::Index size = options.swarm > 0 ? options.swarm : std::max<Eigen::Index>(20, 4 * m);
  const int iterations = options.iterations > 0 ? options.iterations : 20000;
  const BoundaryMap map(options.boundary);
  Coefficients c{options.inertia >= 0 ? options.inertia : 0.6, options.c1 >= 0 ? options.c1 : 0.8,
                 options.c2 >= 0 ? options.c2 : 1.2, map.reach()};
  Swarm s = start_swarm(run, size, map);
  Links links = draw_links(run.random(), size, options.informants);
  Vector costs(size);
  for (int it = 0; it < iterations && !run.stop(); ++it) {
    const double low = s.best_costs.minCoeff();
    const double range = s.best_costs.maxCoeff() - low;
    if (range <= options.cost_tolerance * std::abs(low))
      return {Termination::Settled,
              fmt::format("cost range of the personal bests {:.2g} <= {:.2g} times the cost", range,
                          options.cost_tolerance)};
    const double spread = (s.best.rowwise().maxCoeff() - s.best.rowwise().minCoeff()).maxCoeff();
    if (spread <= 1e-12)
      return {Termination::Settled,
              fmt::format("width of the personal bests {:.2g} <= 1e-12 of the box", spread)};
    move(s, links, c, run.random());
    run.batch_cost(map.to_box(s.x), costs);
    if (run.stop()) break;
    const int bettered = s.remember(costs);
    const double share = static_cast<double>(bettered) / static_cast<double>(size);
    c.w = std::clamp(c.w + kInertiaRate * (share - kInertiaAim), kInertiaLowest, kInertiaHighest);
    if (!(s.best_costs.minCoeff() < low)) links = draw_links(run.random(), size, options.informants);
    run.iteration();
  }
  return {Termination::IterationLimit, fmt::format("{} iterations >= limit {}", iterations, iterations)};
}

}  // namespace odobench
