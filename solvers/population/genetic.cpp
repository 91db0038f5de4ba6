#include "solvers/population/genetic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "solvers/box/boundary_map.hpp"
#include "solvers/population/genetic_thesis.hpp"

namespace odobench {
namespace {

std::vector<Eigen::Index> ordered(const Vector& costs) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(costs.size()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](Eigen::Index a, Eigen::Index b) { return costs[a] < costs[b]; });
  return order;
}

// `count` different members of {0 .. size-1}, sorted by cost.
std::vector<Eigen::Index> draw_parents(Random& random, const Vector& costs, int count) {
  std::vector<Eigen::Index> all(static_cast<std::size_t>(costs.size()));
  std::iota(all.begin(), all.end(), Eigen::Index{0});
  for (int i = 0; i < count; ++i)
    std::swap(all[static_cast<std::size_t>(i)],
              all[static_cast<std::size_t>(random.integer(i, costs.size() - 1))]);
  all.resize(static_cast<std::size_t>(count));
  std::stable_sort(all.begin(), all.end(),
                   [&](Eigen::Index a, Eigen::Index b) { return costs[a] < costs[b]; });
  return all;
}

// (R): parents in the order of their costs, one per column.
struct Brood {
  Matrix xi;  // n_p x n_c, standard normal
  Matrix y;   // m x n_c
};
Brood recombine(Random& random, const Matrix& parents, int count, double expansion,
                const GeneticOptions& options) {
  const Eigen::Index np = parents.cols();
  Vector weights = Vector::Ones(np);
  if (options.weights)
    for (Eigen::Index j = 0; j < np; ++j)
      weights[j] = std::log(static_cast<double>(np + 1)) - std::log(static_cast<double>(j + 1));
  weights /= weights.sum();
  const Vector centre = parents * weights;
  const Vector mean = parents.rowwise().mean();
  const Matrix differences = parents.colwise() - mean;
  Brood brood{Matrix(np, count), {}};
  for (double& value : brood.xi.reshaped()) value = random.normal();
  brood.y = (expansion / std::sqrt(static_cast<double>(np)) * (differences * brood.xi)).colwise() + centre;
  return brood;
}

// rho of (E): s is the mean of the xi of the better quarter of the children, without the component along (1,
// .., 1), which moves nothing.
double common_displacement(const Matrix& xi, const Vector& costs) {
  const std::vector<Eigen::Index> order = ordered(costs);
  const auto n = static_cast<Eigen::Index>(order.size() / 4);
  if (n < 1 || xi.rows() < 2) return 1.0;
  Vector s = Vector::Zero(xi.rows());
  for (Eigen::Index j = 0; j < n; ++j) s += xi.col(order[static_cast<std::size_t>(j)]);
  s /= static_cast<double>(n);
  s.array() -= s.mean();
  return s.squaredNorm() * static_cast<double>(n) / static_cast<double>(xi.rows() - 1);
}

// (E). A population that has lost its width cannot win it back, one that spreads forever never converges:
// hence the limits. The aim is measured: with 0.9 some populations no longer contract, with 1.6
// most contract too early.
double adapted(double expansion, double ratio) {
  constexpr double kRate = 0.02, kAim = 1.1, kLowest = 0.8, kHighest = 1.5;
  return std::clamp(expansion * std::exp(kRate * (ratio - kAim)), kLowest, kHighest);
}

// The modern algorithm's population; members and their costs.
struct Population {
  Matrix y;
  Vector costs;
};

void replace(Population& p, const std::vector<Eigen::Index>& places, const Matrix& children,
             const Vector& child_costs, bool elitist) {
  const auto np = static_cast<Eigen::Index>(places.size());
  Eigen::Index best = 0;
  p.costs.minCoeff(&best);
  Matrix y(p.y.rows(), np + children.cols());
  Vector costs(np + children.cols());
  y.leftCols(np) = p.y(Eigen::all, places);
  y.rightCols(children.cols()) = children;
  costs.head(np) = p.costs(places);
  costs.tail(children.cols()) = child_costs;
  if (!elitist)
    for (Eigen::Index j = 0; j < np; ++j)
      if (places[static_cast<std::size_t>(j)] != best) costs[j] = std::numeric_limits<double>::infinity();
  const std::vector<Eigen::Index> order = ordered(costs);
  for (Eigen::Index j = 0; j < np; ++j) {
    const Eigen::Index from = order[static_cast<std::size_t>(j)];
    p.y.col(places[static_cast<std::size_t>(j)]) = y.col(from);
    p.costs[places[static_cast<std::size_t>(j)]] = costs[from];
  }
}

}  // namespace

void GeneticOptions::bind(OptionBinder& binder) {
  binder.choice("variant", variant, "modern: multi-parent, frame-independent; thesis: the Zagreb program",
                {"modern", "thesis"});
  binder.automatic("population", population, "members; auto: modern 5 per parameter (at least 20), thesis 12",
                   3, kLargestPopulation);
  binder.automatic("generations", generations, "limit; auto: modern 20000, thesis 600", 1,
                   std::numeric_limits<int>::max());
  binder.automatic("parents", parents,
                   "modern: parents of one generation; auto: 2 per parameter (at least 8)", 2,
                   kLargestPopulation);
  binder.automatic("children", children,
                   "modern: children of one generation; auto: 6 per parameter (at least 12)", 1,
                   kLargestPopulation);
  binder.number("expansion", expansion, "modern: spread of the first children relative to their parents'",
                0.1, 10);
  binder.flag("adapt", adapt, "modern: the expansion follows the success of the children (E)");
  binder.flag("weights", weights, "modern: children around the weighted mean, the better parents weigh more");
  binder.flag("elitist", elitist, "modern: parents compete with their children");
  binder.number("cost_tolerance", cost_tolerance,
                "modern: stop when the population's costs differ by at most this times the cost", 0, 1);
  binder.number("boundary", boundary,
                "modern: width of the zone next to a bound in which the coordinates are bent", 1e-6, 1);
  binder.number("pc", pc, "thesis: probability of crossover per couple", 0, 1);
  binder.number("pm", pm, "thesis: probability of mutation per gene", 0, 1);
  binder.integer("crossover", crossover, "thesis: kind of crossover", 0, 6);
  binder.number("factor_low", factor_low, "thesis: a mutated gene is multiplied by at least this", 0, 1e6);
  binder.number("factor_high", factor_high, "thesis: ... and at most this", 0, 1e6);
  binder.number("eta", eta, "thesis: distribution index of the blends 5 and 6", 0, 1000);
}

void GeneticOptions::validate() const {
  const auto refuse = [](const std::string& what) { throw std::invalid_argument("solver 'ga': " + what); };
  if (parents > 0 && population > 0 && parents > population)
    refuse(fmt::format("option parents={} > population={}; expected parents <= population", parents,
                       population));
  if (parents > 0 && children > 0 && children < parents && !elitist)
    refuse(fmt::format("option children={} < parents={}; expected children >= parents with elitist=false",
                       children, parents));
  if (factor_low > factor_high)
    refuse(fmt::format("option factor_low={} > factor_high={}; expected factor_low <= factor_high",
                       factor_low, factor_high));
}

Outcome Genetic::minimise(Run& run) const {
  return options_.variant == "thesis" ? minimise_genetic_thesis(run, options_) : modern(run);
}

Outcome Genetic::modern(Run& run) const {
  const Eigen::Index m = run.dimension();
  const int size = options_.population > 0 ? options_.population : std::max(20, static_cast<int>(5 * m));
  const int parents =
      std::min(size, options_.parents > 0 ? options_.parents : std::max(8, static_cast<int>(2 * m)));
  const int children = options_.children > 0 ? options_.children : std::max(12, static_cast<int>(6 * m));
  const int generations = options_.generations > 0 ? options_.generations : 20000;
  const BoundaryMap map(options_.boundary);

  Population p{Matrix(m, size), Vector(size)};
  for (double& y : p.y.reshaped()) y = run.random().uniform(-map.reach(), map.reach());
  p.y.col(0) = map.from_box(run.start());
  run.batch_cost(map.to_box(p.y), p.costs);
  Vector child_costs(children);
  double expansion = options_.expansion;
  for (int g = 0; g < generations && !run.stop(); ++g) {
    const double low = p.costs.minCoeff();
    const double range = p.costs.maxCoeff() - low;
    if (range <= options_.cost_tolerance * std::abs(low))
      return {Termination::Settled,
              fmt::format("cost range of the population {:.2g} <= {:.2g} times the cost", range,
                          options_.cost_tolerance)};
    const double spread = (p.y.rowwise().maxCoeff() - p.y.rowwise().minCoeff()).maxCoeff();
    if (spread <= 1e-12)
      return {Termination::Settled,
              fmt::format("width of the population {:.2g} <= 1e-12 of the box", spread)};
    const std::vector<Eigen::Index> chosen = draw_parents(run.random(), p.costs, parents);
    const Brood brood = recombine(run.random(), p.y(Eigen::all, chosen), children, expansion, options_);
    run.batch_cost(map.to_box(brood.y), child_costs);
    if (run.stop()) break;
    replace(p, chosen, brood.y, child_costs, options_.elitist);
    if (options_.adapt) expansion = adapted(expansion, common_displacement(brood.xi, child_costs));
    run.iteration();
  }
  return {Termination::IterationLimit, fmt::format("{} generations >= limit {}", generations, generations)};
}

SolverEntry genetic_entry() {
  return make_entry<Genetic, GeneticOptions>(
      "ga", "genetic algorithm: multi-parent recombination, or the thesis' program", true);
}

}  // namespace odobench
