#include "solvers/population/cmaes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "solvers/box/boundary_map.hpp"
#include "solvers/population/cma_core.hpp"

namespace odobench {
namespace {

struct DescentSetting {
  Vector start;  // unit coordinates
  double sigma = 0;
  int population = 0;
  int generations = 0;
};

struct DescentResult {
  double best = std::numeric_limits<double>::infinity();
  Vector best_u;
  double first_median = std::numeric_limits<double>::infinity();
  std::int64_t evaluations = 0;
  std::string message;
  Termination end = Termination::IterationLimit;
};

DescentResult descend(Run& run, const DescentSetting& setting, const CmaesOptions& options) {
  const BoundaryMap map(options.boundary);
  CmaDescent descent(map.from_box(setting.start), setting.sigma, setting.population, options.active);
  DescentResult result;
  Vector costs(setting.population);
  const std::int64_t before = run.evaluations();
  for (int g = 0; g < setting.generations; ++g) {
    const Matrix candidates = map.to_box(descent.sample(run.random()));
    run.batch_cost(candidates, costs);
    result.evaluations = run.evaluations() - before;
    Eigen::Index first = 0;
    if (const double low = costs.minCoeff(&first); low < result.best) {
      result.best = low;
      result.best_u = candidates.col(first);
    }
    if (run.stop()) return result;
    run.iteration();
    if (g == 0) {
      Vector sorted = costs;
      std::sort(sorted.begin(), sorted.end());
      result.first_median = sorted[setting.population / 2];
    }
    descent.update(costs);
    if (const auto end = descent.finished(options.cost_tolerance, options.step_tolerance)) {
      result.message = end->reason;
      result.end = end->by_tolerance ? Termination::Settled : Termination::Stalled;
      return result;
    }
  }
  result.message = fmt::format("{} generations >= limit {}", setting.generations, setting.generations);
  return result;
}

// Two descents that ended in the same place, judged by the costs and, coarsely because a valley may be flat,
// the points.
bool same_minimum(const DescentResult& a, const DescentResult& b) {
  if (!std::isfinite(a.best) || !std::isfinite(b.best)) return false;
  const double scale = std::max({std::abs(a.best), std::abs(b.best), b.first_median - b.best});
  return std::abs(a.best - b.best) <= 1e-9 * scale && (a.best_u - b.best_u).cwiseAbs().maxCoeff() <= 0.05;
}

// The sequence of descents: populations, steps and starts of the two restart strategies.
class Restarts {
 public:
  Restarts(const CmaesOptions& options, Eigen::Index m) : options_(options), m_(m) {
    base_ = options.population > 0 ? options.population
                                   : 4 + static_cast<int>(5.0 * std::log(static_cast<double>(m)));
    large_ = base_;
  }
  DescentSetting first(const Vector& start) const { return limited({start, options_.sigma, base_, 0}); }
  DescentSetting next(Random& random) {
    DescentSetting setting;
    setting.start.resize(m_);
    for (double& u : setting.start) u = random.uniform(-1.0, 1.0);
    setting.sigma = options_.sigma;
    small_ = small_is_next();
    ++count_;
    if (small_) {
      const double u = random.uniform();
      const double ratio = 0.5 * large_ / base_;
      setting.population = static_cast<int>(base_ * std::pow(std::max(1.0, ratio), u * u));
      setting.sigma *= std::pow(10.0, -2.0 * random.uniform());
    } else {
      large_ = std::min(large_, 1 << 20) * 2;
      ++doubled_;
      setting.population = large_;
    }
    return limited(setting);
  }
  bool small_is_next() const {
    return options_.strategy == "bipop" && doubled_ > 0 && spent_small_ < spent_large_;
  }
  int count() const { return count_; }
  int large() const { return doubled_; }
  void spent(std::int64_t evaluations) { (small_ ? spent_small_ : spent_large_) += evaluations; }

 private:
  DescentSetting limited(DescentSetting s) const {
    const double m3 = static_cast<double>(m_) + 3.0;
    s.generations =
        options_.generations > 0
            ? options_.generations
            : 100 + static_cast<int>(50.0 * m3 * m3 / std::sqrt(static_cast<double>(s.population)));
    return s;
  }
  const CmaesOptions& options_;
  Eigen::Index m_;
  int base_ = 0, large_ = 0;
  bool small_ = false;
  int count_ = 0, doubled_ = 0;
  std::int64_t spent_large_ = 0, spent_small_ = 0;
};

}  // namespace

void CmaesOptions::bind(OptionBinder& binder) {
  binder.automatic("population", population,
                   "samples per generation of the first descent; auto: 4 + 5 ln(parameters)", 2,
                   kLargestPopulation);
  binder.number("sigma", sigma, "first standard deviation, half-widths of the box", 1e-12, 10);
  binder.flag("active", active, "negative weights for the worse half of the samples");
  binder.choice("strategy", strategy, "how restarts choose their population", {"ipop", "bipop"});
  binder.integer(
      "restarts", restarts,
      "most restarts with a doubled population; ends earlier when a restart finds the best point again", 0,
      1000);
  binder.automatic("generations", generations,
                   "limit per descent; auto: 100 + 50 (parameters + 3)^2 / sqrt(population)", 1,
                   std::numeric_limits<int>::max());
  binder.number("cost_tolerance", cost_tolerance,
                "a descent ends when recent costs differ by at most this times the cost", 0, 1);
  binder.number("step_tolerance", step_tolerance,
                "a descent ends when all deviations are below this times the first", 0, 1);
  binder.number("boundary", boundary, "width of the zone next to a bound in which the coordinates are bent",
                1e-6, 1);
}

void CmaesOptions::validate() const {}

std::string Cmaes::why_not(const Problem&) const {
  return {};
}

Outcome Cmaes::minimise(Run& run) const {
  Restarts restarts(options_, run.dimension());
  DescentResult best = descend(run, restarts.first(run.start()), options_);
  if (run.stop()) return {};
  restarts.spent(best.evaluations);
  if (options_.restarts == 0) return {best.end, best.message};
  for (;;) {
    const DescentResult result = descend(run, restarts.next(run.random()), options_);
    if (run.stop()) return {};
    restarts.spent(result.evaluations);
    const bool again = same_minimum(best, result);
    if (result.best < best.best) best = result;
    if (again)
      return {Termination::Settled,
              fmt::format("restart {} ended at the best point again; {}", restarts.count(), result.message)};
    if (restarts.large() >= options_.restarts && !restarts.small_is_next())
      return {Termination::IterationLimit,
              fmt::format("{} restarts with a doubled population >= limit {}; {}", restarts.large(),
                          options_.restarts, best.message)};
  }
}

SolverEntry cmaes_entry() {
  return make_entry<Cmaes, CmaesOptions>(
      "cmaes", "CMA-ES with bounds by a smooth map and restarts with growing populations", true);
}

}  // namespace odobench
