// The swarm of MATLAB's particleswarm (Global Optimization Toolbox), after its documentation page "Particle
// Swarm Optimization Algorithm": random neighbourhoods whose size N grows while the best does not improve,
// and an inertia W that follows a counter s of such iterations.
//   start      x uniform in the box, v uniform in plus or minus its width, W = 1.1,
//              N = N_min = max(2, floor(swarm * 0.25))
//   iteration  for each particle: g = best personal best among N random other particles;
//              v <- W v + 1.49 u1 (.) (p - x) + 1.49 u2 (.) (g - x), x <- x + v; a coordinate outside the box
//              is put on the bound and its velocity zeroed
//   improved   s <- max(0, s - 1), N <- N_min, W <- 2 W if s < 2, W / 2 if s > 5, kept in [0.1, 1.1]
//   otherwise  s <- s + 1, N <- min(N + N_min, swarm)
//   stop       the best changed by less than 1e-6 of its size over 20 iterations, or 200 m iterations.
//              (The toolbox divides by max(1, |J|); here by |J|, so that the unit of the cost plays no part.)
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "solvers/population/particle_swarm.hpp"

namespace odobench {
namespace {

constexpr double kLowestInertia = 0.1, kHighestInertia = 1.1;

// The best among `count` random particles other than k.
Eigen::Index best_neighbour(Random& random, const Vector& best_costs, Eigen::Index k, Eigen::Index count,
                            std::vector<Eigen::Index>& others) {
  others.resize(static_cast<std::size_t>(best_costs.size()));
  std::iota(others.begin(), others.end(), Eigen::Index{0});
  std::swap(others[static_cast<std::size_t>(k)], others.back());
  others.pop_back();
  const auto last = static_cast<Eigen::Index>(others.size()) - 1;
  Eigen::Index best = -1;
  for (Eigen::Index i = 0; i < std::min(count, last + 1); ++i) {
    std::swap(others[static_cast<std::size_t>(i)], others[static_cast<std::size_t>(random.integer(i, last))]);
    const Eigen::Index j = others[static_cast<std::size_t>(i)];
    if (best < 0 || best_costs[j] < best_costs[best]) best = j;
  }
  return best;
}

struct Adaptation {
  Eigen::Index smallest, size, neighbours;
  double w = kHighestInertia;
  int stalled = 0;
  void update(bool improved) {
    if (!improved) {
      ++stalled;
      neighbours = std::min(neighbours + smallest, size);
      return;
    }
    stalled = std::max(0, stalled - 1);
    neighbours = smallest;
    if (stalled < 2) w *= 2.0;
    if (stalled > 5) w /= 2.0;
    w = std::clamp(w, kLowestInertia, kHighestInertia);
  }
};

}  // namespace

Outcome minimise_swarm_matlab(Run& run, const ParticleSwarmOptions& options) {
  const Eigen::Index m = run.dimension();
  const Eigen::Index size = options.swarm > 0 ? options.swarm : std::min<Eigen::Index>(100, 10 * m);
  const auto iterations = options.iterations > 0 ? options.iterations : static_cast<int>(200 * m);
  const double c1 = options.c1 >= 0 ? options.c1 : 1.49;
  const double c2 = options.c2 >= 0 ? options.c2 : 1.49;
  const auto share =
      static_cast<Eigen::Index>(std::floor(static_cast<double>(size) * options.min_neighbours));
  Adaptation a{std::max<Eigen::Index>(2, share), size, std::max<Eigen::Index>(2, share)};
  if (options.inertia >= 0) a.w = std::clamp(options.inertia, kLowestInertia, kHighestInertia);
  Random& random = run.random();
  Swarm s{Matrix(m, size), Matrix(m, size), {}, Vector(size)};
  for (double& u : s.x.reshaped()) u = random.uniform(-1.0, 1.0);
  for (double& v : s.v.reshaped()) v = random.uniform(-2.0, 2.0);
  s.best = s.x;
  run.batch_cost(s.x, s.best_costs);
  std::vector<double> history{s.best_costs.minCoeff()};
  std::vector<Eigen::Index> others;
  Vector costs(size);
  for (int it = 0; it < iterations && !run.stop(); ++it) {
    for (Eigen::Index k = 0; k < size; ++k) {
      const Eigen::Index g = best_neighbour(random, s.best_costs, k, a.neighbours, others);
      for (Eigen::Index i = 0; i < m; ++i) {
        const double u1 = random.uniform();
        const double u2 = random.uniform();
        s.v(i, k) =
            a.w * s.v(i, k) + c1 * u1 * (s.best(i, k) - s.x(i, k)) + c2 * u2 * (s.best(i, g) - s.x(i, k));
      }
    }
    s.x += s.v;
    for (Eigen::Index j = 0; j < s.x.size(); ++j) {
      double& u = s.x.reshaped()[j];
      if (std::abs(u) <= 1.0) continue;
      u = std::copysign(1.0, u);
      s.v.reshaped()[j] = 0;
    }
    run.batch_cost(s.x, costs);
    if (run.stop()) break;
    s.remember(costs);
    history.push_back(s.best_costs.minCoeff());
    a.update(history.back() < history[history.size() - 2]);
    run.iteration();
    const auto window = static_cast<std::size_t>(options.stall_iterations);
    if (history.size() <= window) continue;
    const double change = history[history.size() - 1 - window] - history.back();
    if (change < options.function_tolerance * std::abs(history.back()))
      return {Termination::Settled,
              fmt::format("the best changed by {:.2g} < {:.2g} times the cost in {} iterations", change,
                          options.function_tolerance, options.stall_iterations)};
  }
  return {Termination::IterationLimit, fmt::format("{} iterations >= limit {}", iterations, iterations)};
}

}  // namespace odobench
