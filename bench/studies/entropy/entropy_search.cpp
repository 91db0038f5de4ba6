#include "bench/studies/entropy/entropy_search.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "base/random.hpp"
#include "problems/entropy/window_problem.hpp"
#include "solvers/lattice/ternary_search.hpp"

namespace odobench {

RegistrySearch::RegistrySearch(const ProfileForm& profile, const Catalogue& catalogue, SolverSpec solver,
                               const Budget& budget, std::uint64_t seed, const Stop& stop)
    : profile_(profile), solver_(std::move(solver)), stop_(stop), seed_(seed) {
  options_.budget = budget;
  options_.interrupt = stop.flag();
  options_.solvers = &catalogue.solvers();
}

void RegistrySearch::observe(const EntropySample& sample) {
  samples_.push_back(sample);
  if (samples_.size() > static_cast<std::size_t>(profile_.constants().samples)) samples_.pop_front();
}

SearchResult RegistrySearch::minimise(std::span<const double> g, std::span<double> x) {
  EntropyWindow window;
  window.constants = profile_.constants();
  window.samples.assign(samples_.begin(), samples_.end());
  const Problem problem(WindowProblem(std::move(window)));
  options_.seed = derive_seed(seed_, {"filter", solver_.text(), std::to_string(window_++)});
  const Result result = solve(problem, solver_, problem.start(), options_);
  SearchResult found;
  if (result.termination == Termination::NotApplicable)
    throw std::invalid_argument(
        fmt::format("--solver={}: cannot run on windows of the filter: {}", solver_.text(), result.message));
  if (!result.usable()) {
    if (stop_.requested()) return found;
    throw std::runtime_error(
        fmt::format("window {}: {} gave no result: {}", window_ - 1, solver_.text(), result.message));
  }
  found.iterations = static_cast<int>(result.iterations);
  found.evaluations = result.counts.total();
  std::size_t first = 0;
  for (const QuadraticBlock& block : profile_.blocks()) {
    const Vector part = result.x(block.index);
    const Eigen::Map<const Vector> linear(g.data() + first, part.size());
    found.cost += part.dot(block.q * part) - linear.dot(part);
    for (Eigen::Index i = 0; i < part.size(); ++i) x[first + static_cast<std::size_t>(i)] = part[i];
    first += static_cast<std::size_t>(part.size());
  }
  return found;
}

FilterMethod make_filter_method(const std::string& text, const Catalogue& catalogue,
                                const ProfileForm& profile, const Budget& budget, std::uint64_t seed,
                                InstructionSet kernel, const Stop& stop) {
  const std::vector<SolverSpec> list = parse_solver_list(text);
  if (list.size() != 1) throw std::invalid_argument(fmt::format("--solver={}: expected one solver", text));
  FilterMethod method;
  method.spec = list.front();
  const bool plain = method.spec.options.empty();
  if (method.spec.name == "zero") {
    if (!plain) throw std::invalid_argument("--solver=zero: takes no options");
  } else if (plain && method.spec.name == "coordinate") {
    method.search = ternary_greedy(profile.blocks(), kernel);
  } else if (plain && method.spec.name == "exact") {
    method.search = ternary_exact(
        profile.blocks(), [stop] { return stop.requested(); }, kernel);
  } else if (plain && method.spec.name == "relaxed") {
    method.search = box_relaxation(profile.blocks());
  } else {
    catalogue.solver(method.spec.name).make(method.spec.options, nullptr);  // throws on a bad name or option
    auto search = std::make_unique<RegistrySearch>(profile, catalogue, method.spec, budget, seed, stop);
    method.registry = search.get();
    method.search = std::move(search);
  }
  return method;
}

}  // namespace odobench
