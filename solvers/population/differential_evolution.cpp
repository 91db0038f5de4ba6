#include "solvers/population/differential_evolution.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "solvers/box/boundary_map.hpp"

namespace odobench {
namespace {

constexpr Eigen::Index kSmallest = 4;  // (D1) needs four different individuals

// The means that F and CR are drawn around.
class Memory {
 public:
  explicit Memory(int places) : f_(Vector::Constant(places, 0.5)), cr_(Vector::Constant(places, 0.5)) {}

  struct Pair {
    double f, cr;
  };
  Pair draw(Random& random) const {
    const Eigen::Index r = random.integer(0, f_.size() - 1);
    double f = 0;
    while (f <= 0) f = f_[r] + 0.1 * std::tan(std::numbers::pi * (random.uniform() - 0.5));
    const double cr = cr_[r] < 0 ? 0.0 : std::clamp(cr_[r] + 0.1 * random.normal(), 0.0, 1.0);
    return {std::min(f, 1.0), cr};
  }
  void succeeded(const Pair& pair, double gain) {
    // A first finite cost gains more than any number.
    wins_.push_back({pair, std::isfinite(gain) ? gain : std::numeric_limits<double>::max() / 1e10});
  }
  // At the end of a generation.
  void learn() {
    if (wins_.empty()) return;
    double largest = 0;
    for (const Win& w : wins_) largest = std::max(largest, w.gain);
    double f1 = 0, f2 = 0, c1 = 0, c2 = 0;
    for (const Win& w : wins_) {
      const double weight = w.gain / largest;
      f1 += weight * w.pair.f;
      f2 += weight * w.pair.f * w.pair.f;
      c1 += weight * w.pair.cr;
      c2 += weight * w.pair.cr * w.pair.cr;
    }
    f_[next_] = f2 / f1;
    // Only zeros succeeded: it stays with them (L-SHADE's terminal value).
    cr_[next_] = c1 > 0 && cr_[next_] >= 0 ? c2 / c1 : -1;
    next_ = (next_ + 1) % f_.size();
    wins_.clear();
  }

 private:
  struct Win {
    Pair pair;
    double gain;
  };
  Vector f_, cr_;
  Eigen::Index next_ = 0;
  std::vector<Win> wins_;
};

class Evolution {
 public:
  Evolution(Run& run, const DifferentialEvolutionOptions& o)
      : run_(run), options_(o), map_(o.boundary), memory_(o.memory) {
    const Eigen::Index m = run.dimension();
    largest_ = std::max<Eigen::Index>(o.population > 0 ? o.population : 18 * m, kSmallest);
    schedule_ = o.evaluations > 0 ? o.evaluations : 2400 * m;
    if (o.evaluations == 0) schedule_ = std::min<std::int64_t>(schedule_, run.evaluations_left());
    begin_ = run.evaluations();
    x_.resize(m, largest_);
    for (double& y : x_.reshaped()) y = run.random().uniform(-map_.reach(), map_.reach());
    x_.col(0) = map_.from_box(run.start());
    costs_.resize(largest_);
    run.batch_cost(map_.to_box(x_), costs_);
  }

  bool used_up() const { return run_.evaluations() - begin_ >= schedule_; }
  std::int64_t schedule() const { return schedule_; }
  // Highest minus lowest cost.
  double range() const { return costs_.maxCoeff() - costs_.minCoeff(); }
  double lowest() const { return costs_.minCoeff(); }
  double width() const { return (x_.rowwise().maxCoeff() - x_.rowwise().minCoeff()).maxCoeff(); }

  void generation() {
    const Eigen::Index n = x_.cols();
    order_.resize(static_cast<std::size_t>(n));
    std::iota(order_.begin(), order_.end(), Eigen::Index{0});
    std::stable_sort(order_.begin(), order_.end(),
                     [&](Eigen::Index a, Eigen::Index b) { return costs_[a] < costs_[b]; });
    const Matrix frame = better_half_frame();
    Matrix trials(x_.rows(), n);
    std::vector<Memory::Pair> pairs;
    for (Eigen::Index k = 0; k < n; ++k) {
      pairs.push_back(memory_.draw(run_.random()));
      trials.col(k) = trial(k, pairs.back(), frame);
    }
    Vector costs(n);
    run_.batch_cost(map_.to_box(trials), costs);
    if (run_.stop()) return;
    for (Eigen::Index k = 0; k < n; ++k)
      select(k, trials.col(k), costs[k], pairs[static_cast<std::size_t>(k)]);
    memory_.learn();
    shrink();
    run_.iteration();
  }

 private:
  Matrix better_half_frame() const {
    const std::size_t half = std::max<std::size_t>(order_.size() / 2, 2);
    Matrix better(x_.rows(), static_cast<Eigen::Index>(half));
    for (std::size_t k = 0; k < half; ++k) better.col(static_cast<Eigen::Index>(k)) = x_.col(order_[k]);
    const Matrix centred = better.colwise() - Vector(better.rowwise().mean());
    return Eigen::SelfAdjointEigenSolver<Matrix>(Matrix(centred * centred.transpose())).eigenvectors();
  }

  Eigen::Index other_than(Eigen::Index first, Eigen::Index second, Eigen::Index count) {
    Eigen::Index drawn = first;
    while (drawn == first || drawn == second) drawn = run_.random().integer(0, count - 1);
    return drawn;
  }

  // (D1), (D2) and the way back into the box.
  Vector trial(Eigen::Index k, const Memory::Pair& pair, const Matrix& frame) {
    Random& random = run_.random();
    const Eigen::Index n = x_.cols(), m = x_.rows();
    const auto best = std::max<Eigen::Index>(2, std::lround(options_.greed * static_cast<double>(n)));
    const Eigen::Index p = order_[static_cast<std::size_t>(random.integer(0, best - 1))];
    const Eigen::Index a = other_than(k, k, n);
    const Eigen::Index b = other_than(k, a, n + static_cast<Eigen::Index>(archive_.size()));
    const Vector parent = x_.col(k);
    const Vector far = b < n ? Vector(x_.col(b)) : archive_[static_cast<std::size_t>(b - n)];
    const Vector v = parent + pair.f * (x_.col(p) - parent) + pair.f * (x_.col(a) - far);
    const bool turned = random.uniform() < options_.frame;
    const Vector from = turned ? Vector(frame.transpose() * parent) : parent;
    const Vector to = turned ? Vector(frame.transpose() * v) : v;
    const Eigen::Index always = random.integer(0, m - 1);
    Vector mixed = from;
    for (Eigen::Index i = 0; i < m; ++i)
      if (random.uniform() < pair.cr || i == always) mixed[i] = to[i];
    Vector t = turned ? Vector(frame * mixed) : mixed;
    for (Eigen::Index i = 0; i < m; ++i)
      if (std::abs(t[i]) > map_.reach()) t[i] = 0.5 * (parent[i] + std::copysign(map_.reach(), t[i]));
    return t;
  }

  void select(Eigen::Index k, const ConstVectorRef& trial, double cost, const Memory::Pair& pair) {
    if (!(cost <= costs_[k])) return;
    if (cost < costs_[k]) {
      memory_.succeeded(pair, costs_[k] - cost);
      archive_.push_back(x_.col(k));
      limit_archive();
    }
    x_.col(k) = trial;
    costs_[k] = cost;
  }

  void limit_archive() {
    const auto most = static_cast<std::size_t>(options_.archive * static_cast<double>(x_.cols()));
    while (archive_.size() > most) {
      const auto leaves = run_.random().integer(0, static_cast<std::int64_t>(archive_.size()) - 1);
      archive_[static_cast<std::size_t>(leaves)] = archive_.back();
      archive_.pop_back();
    }
  }

  // (D3): the worst leave.
  void shrink() {
    const double part =
        std::min(1.0, static_cast<double>(run_.evaluations() - begin_) / static_cast<double>(schedule_));
    const Eigen::Index aim = std::max<Eigen::Index>(
        kSmallest,
        std::lround(static_cast<double>(largest_) + static_cast<double>(kSmallest - largest_) * part));
    while (x_.cols() > aim) {
      Eigen::Index worst = 0;
      costs_.maxCoeff(&worst);
      const Eigen::Index last = x_.cols() - 1;
      x_.col(worst) = x_.col(last).eval();
      costs_[worst] = costs_[last];
      x_.conservativeResize(Eigen::NoChange, last);
      costs_.conservativeResize(last);
    }
    limit_archive();
  }

  Run& run_;
  const DifferentialEvolutionOptions& options_;
  BoundaryMap map_;
  Memory memory_;
  Eigen::Index largest_ = 0;
  std::int64_t schedule_ = 0, begin_ = 0;
  Matrix x_;
  Vector costs_;
  std::vector<Eigen::Index> order_;  // the best first
  std::vector<Vector> archive_;
};

}  // namespace

void DifferentialEvolutionOptions::bind(OptionBinder& binder) {
  binder.automatic("population", population, "individuals at first; auto: 18 m", 4, kLargestPopulation);
  binder.automatic(
      "evaluations", evaluations,
      "evaluations until the population has shrunk to 4; auto: 2400 m, or the budget where it is less", 1,
      std::numeric_limits<int>::max());
  binder.integer("memory", memory, "places that remember which F and CR succeeded", 1, 1000);
  binder.number("greed", greed, "share of the best that trials are drawn to", 0.0, 1.0);
  binder.number("archive", archive, "size of the archive of replaced parents, parts of the population", 0.0,
                10.0);
  binder.number("frame", frame, "share of the crossovers in the frame of the better half", 0.0, 1.0);
  binder.number("cost_tolerance", cost_tolerance,
                "settled once the costs' range is at most this part of the cost", 0.0, 1.0);
  binder.number("boundary", boundary, "width of the bent zone at the bounds", 1e-6, 1.0);
}

Outcome DifferentialEvolution::minimise(Run& run) const {
  Evolution evolution(run, options_);
  while (!run.stop()) {
    const double range = evolution.range(), low = std::abs(evolution.lowest());
    if (range <= options_.cost_tolerance * low)
      return {Termination::Settled,
              fmt::format("cost range of the population {:.2g} <= {:.2g} times the cost", range,
                          options_.cost_tolerance)};
    if (evolution.width() <= 1e-12)
      return {Termination::Settled,
              fmt::format("width of the population {:.2g} <= 1e-12 of the box", evolution.width())};
    if (evolution.used_up())
      return {Termination::IterationLimit,
              fmt::format("the schedule of {} evaluations is used up", evolution.schedule())};
    evolution.generation();
  }
  return {};
}

SolverEntry differential_evolution_entry() {
  return make_entry<DifferentialEvolution, DifferentialEvolutionOptions>(
      "de", "differential evolution (L-SHADE) with crossover in the frame of the population", true);
}

}  // namespace odobench
