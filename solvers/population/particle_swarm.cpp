#include "solvers/population/particle_swarm.hpp"

#include <fmt/format.h>

#include <limits>

namespace odobench {

void ParticleSwarmOptions::bind(OptionBinder& binder) {
  binder.choice("variant", variant,
                "modern: moves in the frame of its memory; thesis: (3.13)-(3.14); matlab: particleswarm",
                {"modern", "thesis", "matlab"});
  binder.automatic(
      "swarm", swarm,
      "particles; auto: modern 4 per parameter (at least 20), thesis 100, matlab min(100, 10 per parameter)",
      2, kLargestPopulation);
  binder.automatic("iterations", iterations,
                   "limit; auto: modern 20000, thesis 500, matlab 200 per parameter", 1,
                   std::numeric_limits<int>::max());
  binder.automatic("inertia", inertia,
                   "W; auto: modern 0.6 at first, thesis 0.7298; matlab adapts its own in 0.1..1.1", 0, 2);
  binder.automatic("c1", c1, "attraction to the personal best; auto: modern 0.8, thesis 1.49618, matlab 1.49",
                   0, 10);
  binder.automatic("c2", c2,
                   "attraction to the best neighbour; auto: modern 1.2, thesis 1.49618, matlab 1.49", 0, 10);
  binder.integer("informants", informants, "modern: other particles a particle hears of", 0, 100);
  binder.number("cost_tolerance", cost_tolerance,
                "modern: stop when the personal bests differ by at most this times the cost", 0, 1);
  binder.number("boundary", boundary,
                "modern: width of the zone next to a bound in which the coordinates are bent", 1e-6, 1);
  binder.number("min_neighbours", min_neighbours, "matlab: smallest neighbourhood, share of the swarm", 0, 1);
  binder.integer("stall_iterations", stall_iterations, "matlab: length of the stall test", 1);
  binder.number("function_tolerance", function_tolerance,
                "matlab: stop when the best changed by less than this times the cost in the stall test", 0,
                1);
}

void ParticleSwarmOptions::validate() const {}

int Swarm::remember(const Vector& costs) {
  int count = 0;
  for (Eigen::Index k = 0; k < costs.size(); ++k) {
    if (!(costs[k] < best_costs[k])) continue;
    best_costs[k] = costs[k];
    best.col(k) = x.col(k);
    ++count;
  }
  return count;
}

Outcome ParticleSwarm::minimise(Run& run) const {
  if (options_.variant == "thesis") return minimise_swarm_thesis(run, options_);
  if (options_.variant == "matlab") return minimise_swarm_matlab(run, options_);
  return minimise_swarm_modern(run, options_);
}

Outcome minimise_swarm_thesis(Run& run, const ParticleSwarmOptions& options) {
  const Eigen::Index m = run.dimension();
  const int size = options.swarm > 0 ? options.swarm : 100;
  const int iterations = options.iterations > 0 ? options.iterations : 500;
  const double w = options.inertia >= 0 ? options.inertia : 0.7298;
  const double c1 = options.c1 >= 0 ? options.c1 : 1.49618;
  const double c2 = options.c2 >= 0 ? options.c2 : 1.49618;
  Random& random = run.random();
  Swarm s{Matrix(m, size), Matrix::Zero(m, size), {}, Vector(size)};
  for (double& u : s.x.reshaped()) u = random.uniform(-1.0, 1.0);
  s.best = s.x;
  run.batch_cost(s.x, s.best_costs);
  Vector costs(size);
  for (int it = 0; it < iterations && !run.stop(); ++it) {
    Eigen::Index leader = 0;
    s.best_costs.minCoeff(&leader);
    const Vector g = s.best.col(leader);
    for (Eigen::Index k = 0; k < size; ++k) {
      for (Eigen::Index i = 0; i < m; ++i) {
        const double u1 = random.uniform();
        const double u2 = random.uniform();
        s.v(i, k) =
            w * s.v(i, k) + c1 * u1 * (s.best(i, k) - s.x(i, k)) + c2 * u2 * (g[i] - s.x(i, k));  // (3.13)
      }
    }
    s.x = (s.x + s.v).cwiseMax(-1.0).cwiseMin(1.0);  // (3.14)
    run.batch_cost(s.x, costs);
    if (run.stop()) break;
    s.remember(costs);
    run.iteration();
  }
  return {Termination::IterationLimit, fmt::format("{} iterations >= limit {}", iterations, iterations)};
}

SolverEntry particle_swarm_entry() {
  return make_entry<ParticleSwarm, ParticleSwarmOptions>(
      "pso", "particle swarm in the frame of its memory, the thesis' one, or MATLAB's", true);
}

}  // namespace odobench
