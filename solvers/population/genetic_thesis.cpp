#include "solvers/population/genetic_thesis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace odobench {
namespace {

void weighted_sums(Random& random, Vector& p, Vector& q) {
  const double c = random.uniform();
  const Vector s = c * p + (1.0 - c) * q;
  q = (1.0 - c) * p + c * q;
  p = s;
}

void one_point(Random& random, Vector& p, Vector& q) {
  if (p.size() < 2) return;
  const Eigen::Index cut = random.integer(1, p.size() - 1);
  p.tail(p.size() - cut).swap(q.tail(p.size() - cut));
}

void uniform_exchange(Random& random, Vector& p, Vector& q) {
  for (Eigen::Index i = 0; i < p.size(); ++i)
    if (random.uniform() < 0.5) std::swap(p[i], q[i]);
}

void blend(Random& random, double eta, Vector& p, Vector& q) {
  const double u = random.uniform();
  const double b =
      u <= 0.5 ? std::pow(2.0 * u, 1.0 / (eta + 1.0)) : std::pow(1.0 / (2.0 * (1.0 - u)), 1.0 / (eta + 1.0));
  const Vector s = 0.5 * ((1.0 + b) * p + (1.0 - b) * q);
  q = 0.5 * ((1.0 - b) * p + (1.0 + b) * q);
  p = s;
}

// In parameter units: the factor acts on the value itself, not on its place in the box.
void mutate(Run& run, const GeneticOptions& options, Vector& u) {
  Vector x = run.box().to_parameters(u);
  bool changed = false;
  for (Eigen::Index i = 0; i < u.size(); ++i) {
    if (run.random().uniform() >= options.pm) continue;
    x[run.box().parameter_index(i)] *= run.random().uniform(options.factor_low, options.factor_high);
    changed = true;
  }
  if (changed) u = run.box().to_unit(x);  // clips
}

Matrix offspring(Run& run, const GeneticOptions& options, const Matrix& members, const Vector& costs) {
  const std::vector<Eigen::Index> chosen = roulette(run.random(), costs);
  Matrix next = members(Eigen::all, chosen);
  for (Eigen::Index i = 0; i + 1 < next.cols(); i += 2) {
    if (run.random().uniform() >= options.pc) continue;
    Vector p = next.col(i);
    Vector q = next.col(i + 1);
    thesis_crossover(run.random(), options.crossover, options.eta, p, q);
    next.col(i) = p;
    next.col(i + 1) = q;
  }
  for (Eigen::Index i = 0; i < next.cols(); ++i) {
    Vector u = next.col(i).cwiseMax(-1.0).cwiseMin(1.0);  // blends reach beyond the box
    mutate(run, options, u);
    next.col(i) = u;
  }
  return next;
}

}  // namespace

std::vector<Eigen::Index> roulette(Random& random, const Vector& costs) {
  const Eigen::Index n = costs.size();
  Vector fitness = Vector::Zero(n);
  double sum = 0;
  for (double cost : costs)
    if (std::isfinite(cost)) sum += cost;
  for (Eigen::Index i = 0; i < n; ++i)
    if (std::isfinite(costs[i])) fitness[i] = sum != 0 ? 1.0 - costs[i] / sum : 1.0;
  // Costs of mixed sign can leave no valid wheel (the thesis' costs are sums of squares): every member is
  // equal then.
  if (!(fitness.minCoeff() >= 0 && fitness.sum() > 0)) fitness = Vector::Ones(n);
  std::vector<Eigen::Index> chosen;
  for (Eigen::Index k = 0; k < n; ++k) {
    const double spin = random.uniform() * fitness.sum();
    Eigen::Index i = 0;
    for (double passed = fitness[0]; i + 1 < n && spin >= passed; passed += fitness[i]) ++i;
    chosen.push_back(i);
  }
  return chosen;
}

void thesis_crossover(Random& random, int kind, double eta, Vector& p, Vector& q) {
  if (kind == 1 || kind == 2 || kind == 4 || kind == 6) weighted_sums(random, p, q);
  if (kind == 0 || kind == 1) one_point(random, p, q);
  if (kind == 3 || kind == 4) uniform_exchange(random, p, q);
  if (kind == 5 || kind == 6) blend(random, eta, p, q);
}

Outcome minimise_genetic_thesis(Run& run, const GeneticOptions& options) {
  const Eigen::Index m = run.dimension();
  const int size = options.population > 0 ? options.population : 12;
  const int generations = options.generations > 0 ? options.generations : 600;
  Matrix members(m, size);
  for (double& u : members.reshaped()) u = run.random().uniform(-1.0, 1.0);
  Vector costs(size);
  run.batch_cost(members, costs);
  for (int g = 0; g < generations && !run.stop(); ++g) {
    Matrix next = offspring(run, options, members, costs);
    Vector next_costs(size);
    run.batch_cost(next, next_costs);
    if (run.stop()) break;
    Eigen::Index best = 0;
    costs.minCoeff(&best);
    const Eigen::Index place = run.random().integer(0, size - 1);
    if (costs[best] < next_costs[place]) {
      next.col(place) = members.col(best);
      next_costs[place] = costs[best];
    }
    members = std::move(next);
    costs = std::move(next_costs);
    run.iteration();
  }
  return {Termination::IterationLimit, fmt::format("{} generations >= limit {}", generations, generations)};
}

}  // namespace odobench
