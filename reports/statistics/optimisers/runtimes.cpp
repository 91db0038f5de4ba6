#include "reports/statistics/optimisers/runtimes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/random.hpp"
#include "base/range.hpp"

namespace odobench {
namespace {

// Values in ascending order as steps of 1 / total; infinite ones make none.
StepCurve steps_of(std::vector<double> values, double total) {
  std::sort(values.begin(), values.end());
  StepCurve curve;
  for (std::size_t i = 0; i < values.size() && std::isfinite(values[i]); ++i) {
    const double share = static_cast<double>(i + 1) / total;
    if (!curve.empty() && curve.back().first == values[i])
      curve.back().second = share;
    else
      curve.emplace_back(values[i], share);
  }
  return curve;
}

}  // namespace

ExpectedRuntime expected_runtime(const std::vector<Trial>& trials, double precision) {
  ExpectedRuntime result;
  result.trials = trials.size();
  double sum = 0;
  for (const Trial& trial : trials) {
    const std::optional<double> needed = trial.evaluations_to(precision);
    if (needed) ++result.successes;
    sum += needed.value_or(trial.spent);
  }
  result.evaluations = result.successes == 0 ? kInfinity : sum / static_cast<double>(result.successes);
  return result;
}

std::vector<double> restarted_runtimes(const std::vector<Trial>& trials, double precision, std::size_t count,
                                       std::uint64_t seed) {
  std::vector<std::optional<double>> needed;
  std::size_t successes = 0;
  for (const Trial& trial : trials) {
    needed.push_back(trial.evaluations_to(precision));
    if (needed.back()) ++successes;
  }
  std::vector<double> runtimes;
  if (successes == 0) return runtimes;
  if (successes == trials.size()) {
    for (std::size_t k = 0; k < count; ++k) runtimes.push_back(*needed[k % needed.size()]);
    return runtimes;
  }
  Random random(seed);
  while (runtimes.size() < count) {
    double sum = 0;
    for (bool succeeded = false; !succeeded;) {
      const auto drawn =
          static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(trials.size()) - 1));
      succeeded = needed[drawn].has_value();
      sum += needed[drawn].value_or(trials[drawn].spent);
    }
    runtimes.push_back(sum);
  }
  return runtimes;
}

std::vector<double> ecdf_targets(bool absolute) {
  std::vector<double> targets;
  for (int k = absolute ? 10 : -1; k >= -40; --k) targets.push_back(std::pow(10.0, k / 5.0));
  return targets;
}

double value_at(const StepCurve& curve, double x) {
  double value = 0;
  for (const auto& [at, y] : curve) {
    if (at > x) break;
    value = y;
  }
  return value;
}

StepCurve runtime_distribution(const TrialTable& table, std::size_t solver, std::size_t restarts,
                               std::uint64_t seed) {
  std::vector<double> runtimes;
  std::size_t total = 0;
  for (const ProblemTrials& problem : table.problems) {
    std::uint64_t target_number = 0;
    for (const double target : ecdf_targets(problem.absolute)) {
      total += restarts;
      const std::uint64_t own =
          mixed_seed(derive_seed(seed, {problem.problem, table.solvers[solver]}), target_number++);
      for (const double runtime : restarted_runtimes(problem.of[solver], target, restarts, own))
        runtimes.push_back(runtime / static_cast<double>(problem.dimension));
    }
  }
  return steps_of(std::move(runtimes), static_cast<double>(total));
}

double median_runtime(const std::vector<Trial>& trials, double precision) {
  std::vector<double> runtimes;
  for (const Trial& trial : trials) runtimes.push_back(trial.evaluations_to(precision).value_or(kInfinity));
  if (runtimes.empty()) return kInfinity;
  std::sort(runtimes.begin(), runtimes.end());
  return runtimes[runtimes.size() / 2];
}

StepCurve data_profile(const TrialTable& table, std::size_t solver, double tau) {
  std::vector<double> gradients;
  for (const ProblemTrials& problem : table.problems)
    gradients.push_back(median_runtime(problem.of[solver], tau) / static_cast<double>(problem.dimension + 1));
  return steps_of(std::move(gradients), static_cast<double>(table.problems.size()));
}

StepCurve performance_profile(const TrialTable& table, std::size_t solver, double tau) {
  std::vector<double> ratios;
  for (const ProblemTrials& problem : table.problems) {
    double quickest = kInfinity;
    for (const std::vector<Trial>& trials : problem.of)
      quickest = std::min(quickest, median_runtime(trials, tau));
    if (!std::isfinite(quickest)) continue;
    ratios.push_back(median_runtime(problem.of[solver], tau) / std::max(1.0, quickest));
  }
  return steps_of(std::move(ratios), static_cast<double>(table.problems.size()));
}

}  // namespace odobench
