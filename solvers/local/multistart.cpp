#include "solvers/local/multistart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/random/sobol.hpp>
#include <boost/random/uniform_01.hpp>
#include <cmath>
#include <stdexcept>

namespace odobench {
namespace {

constexpr double kSamePlace = 1e-3, kSameCost = 1e-6, kCostFloor = 1e-12, kLower = 1e-9;
constexpr Eigen::Index kSobolDimensions = 3667;  // of Boost's table

SolverSpec inner_spec(const std::string& text) {
  const std::vector<SolverSpec> list = parse_solver_list(text);
  if (list.size() != 1)
    throw std::invalid_argument(
        fmt::format("solver 'multistart': option solver={}; expected one solver", text));
  if (list.front().name == "multistart")
    throw std::invalid_argument(
        fmt::format("solver 'multistart': option solver={}; expected a local method", text));
  return list.front();
}

std::unique_ptr<Solver> inner_solver(const MultistartOptions& options) {
  const SolverTable& known = options.known != nullptr ? *options.known : known_solvers();
  const SolverSpec spec = inner_spec(options.solver);
  return known.find(spec.name).make(spec.options, nullptr);
}

// The optima seen so far, the lowest first.
class Optima {
 public:
  explicit Optima(double first_cost) : floor_(kCostFloor * first_cost) {}

  void add(const Run& ended) {
    const double cost = ended.best_cost();
    for (Entry& e : entries_) {
      if ((e.u - ended.best()).cwiseAbs().maxCoeff() > kSamePlace) continue;
      if (std::abs(e.found.cost - cost) >
          kSameCost * std::max(std::abs(e.found.cost), std::abs(cost)) + floor_)
        continue;
      ++e.found.runs;
      if (cost < e.found.cost) {
        e.u = ended.best();
        e.found.x = ended.best_parameters();
        e.found.cost = cost;
      }
      sort();
      return;
    }
    entries_.push_back({ended.best(), {ended.best_parameters(), cost, 1}});
    sort();
  }

  std::vector<LocalOptimum> list() const {
    std::vector<LocalOptimum> optima;
    for (const Entry& e : entries_) optima.push_back(e.found);
    return optima;
  }

 private:
  struct Entry {
    Vector u;
    LocalOptimum found;
  };
  void sort() {
    std::stable_sort(entries_.begin(), entries_.end(),
                     [](const Entry& a, const Entry& b) { return a.found.cost < b.found.cost; });
  }
  double floor_;
  std::vector<Entry> entries_;
};

std::string described(const std::vector<LocalOptimum>& optima, int made, int starts) {
  int ended = 0;
  for (const LocalOptimum& o : optima) ended += o.runs;
  std::string text = fmt::format("{} optim{} from {} of {} starts", optima.size(),
                                 optima.size() == 1 ? "um" : "a", made, starts);
  for (std::size_t k = 0; k < std::min<std::size_t>(optima.size(), 3); ++k)
    text += fmt::format("{} {:.10g} ({:.0f} %)", k == 0 ? ":" : ",", optima[k].cost,
                        100.0 * optima[k].runs / ended);
  if (optima.size() > 3) text += ", ...";
  if (made > ended) text += fmt::format("; {} ended in none", made - ended);
  return text;
}

}  // namespace

Matrix sobol_starts(Eigen::Index m, Eigen::Index n, Random& random) {
  boost::random::sobol sequence(static_cast<std::size_t>(m));
  Vector shift(m);
  for (double& s : shift) s = random.uniform();
  Matrix points(m, n);
  boost::random::uniform_01<double> uniform;
  for (double& u : points.reshaped()) u = uniform(sequence);
  for (Eigen::Index k = 0; k < n; ++k)
    for (Eigen::Index i = 0; i < m; ++i) {
      const double moved = points(i, k) + shift[i];
      points(i, k) = 2.0 * (moved - std::floor(moved)) - 1.0;
    }
  return points;
}

Matrix latin_hypercube(Eigen::Index m, Eigen::Index n, Random& random) {
  Matrix points(m, n);
  std::vector<Eigen::Index> stratum(static_cast<std::size_t>(n));
  for (Eigen::Index i = 0; i < m; ++i) {
    for (Eigen::Index k = 0; k < n; ++k) stratum[static_cast<std::size_t>(k)] = k;
    for (Eigen::Index k = n - 1; k > 0; --k)
      std::swap(stratum[static_cast<std::size_t>(k)],
                stratum[static_cast<std::size_t>(random.integer(0, k))]);
    for (Eigen::Index k = 0; k < n; ++k)
      points(i, k) = 2.0 * (static_cast<double>(stratum[static_cast<std::size_t>(k)]) + random.uniform()) /
                         static_cast<double>(n) -
                     1.0;
  }
  return points;
}

void MultistartOptions::bind(OptionBinder& binder) {
  binder.text("solver", solver, "the local method, with its options in brackets", "a solver");
  binder.integer("starts", starts, "starts at most, the run's own among them", 1, 100000);
  binder.choice("sampling", sampling, "how starts are spread over the box", {"sobol", "lhs"});
  binder.number(
      "effort", effort,
      "no further start after this many times the evaluations that the lowest optimum took; 0: every start",
      0.0, 1e6);
}

void MultistartOptions::validate() const {
  inner_spec(solver);
  try {
    inner_solver(*this);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(
        fmt::format("solver 'multistart': option solver={}; {}", solver, error.what()));
  }
}

Multistart::Multistart(MultistartOptions options)
    : options_(std::move(options)), inner_(inner_solver(options_)) {}

std::string Multistart::why_not(const Problem& problem) const {
  if (options_.sampling == "sobol" && problem.dimension() > kSobolDimensions)
    return fmt::format("the Sobol sequence has {} dimensions, the problem {}; sampling=lhs has no limit",
                       kSobolDimensions, problem.dimension());
  return inner_->why_not(problem);
}

Outcome Multistart::minimise(Run& run) const {
  const Eigen::Index m = run.dimension(), others = options_.starts - 1;
  const Matrix starts = options_.sampling == "lhs" ? latin_hypercube(m, others, run.random())
                                                   : sobol_starts(m, others, run.random());
  std::optional<Optima> optima;
  std::int64_t line = 0;  // evaluations after which no start is made; 0: none
  int made = 0;
  bool lowest_settled = false;
  for (; made < options_.starts && !run.stop() && (line == 0 || run.evaluations() < line); ++made) {
    Run local = run.local(made == 0 ? run.start() : Vector(starts.col(made - 1)),
                          line == 0 ? 0 : line - run.evaluations());
    Outcome outcome;
    try {
      outcome = inner_->minimise(local);
    } catch (const std::exception&) {  // a method that breaks down from one start may do well from another
      outcome.termination = Termination::Failed;
    }
    const double before = run.best_cost();
    run.absorb(local);
    if (!local.has_best()) continue;
    const bool settled =
        local.stop_reason() == Termination::NotStarted && outcome.termination == Termination::Settled;
    if (!optima) optima.emplace(local.trace().front().cost);
    if (settled) optima->add(local);
    if (std::isfinite(before) && !(local.best_cost() < before - kLower * std::abs(before))) continue;
    lowest_settled = settled;
    line =
        settled && options_.effort > 0
            ? static_cast<std::int64_t>(std::ceil(options_.effort * static_cast<double>(run.evaluations())))
            : 0;
  }
  run.stop();  // a budget that the last search used up is why it ended
  Outcome result;
  if (optima) result.optima = optima->list();
  result.termination = lowest_settled ? Termination::Settled : Termination::Stalled;
  result.message = described(result.optima, made, options_.starts);
  return result;
}

SolverEntry multistart_entry(const SolverTable& known) {
  MultistartOptions defaults;
  defaults.known = &known;
  return make_entry<Multistart, MultistartOptions>(
      "multistart", "a local method from many starts: distinct optima and the share of their basins", true,
      defaults);
}

}  // namespace odobench
