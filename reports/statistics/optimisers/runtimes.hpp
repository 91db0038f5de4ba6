// Runtimes, in evaluations, of solvers to targets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "reports/statistics/optimisers/trials.hpp"

namespace odobench {

// The expected running time to a gap of `precision` (N. Hansen and others, Real-parameter black-box
// optimization benchmarking: experimental setup, 2009; Price 1997):
//   ERT = (evaluations of successful runs until then + all evaluations of the others) / number of successes
// Infinite without a success, and for no trials.
struct ExpectedRuntime {
  double evaluations = 0;
  std::size_t successes = 0, trials = 0;
};
ExpectedRuntime expected_runtime(const std::vector<Trial>& trials, double precision);

// A runtime with simulated restarts (COCO): trials are drawn with replacement, unsuccessful ones are added
// up until one succeeds. `count` of them, in the order drawn; empty where no trial succeeds. The same seed
// gives the same bits. Where all trials succeed, they are their runtimes in order, over and over.
std::vector<double> restarted_runtimes(const std::vector<Trial>& trials, double precision, std::size_t count,
                                       std::uint64_t seed);

// 10^2, 10^1.8, .. 10^-8 of absolute gaps (51, COCO's), 10^-0.2, 10^-0.4, .. 10^-8 of relative ones (40).
std::vector<double> ecdf_targets(bool absolute);

// A curve of steps: from x on the value is y.
using StepCurve = std::vector<std::pair<double, double>>;
double value_at(const StepCurve& curve, double x);

// The empirical distribution of runtimes of solver number `solver` over all problems and targets: the
// share of (problem, target, simulated runtime) with runtime / dimension <= x. `restarts` simulated
// runtimes per problem and target; targets that no trial reaches count in the denominator.
StepCurve runtime_distribution(const TrialTable& table, std::size_t solver, std::size_t restarts = 100,
                               std::uint64_t seed = 1);

// Evaluations of a solver to a gap on a problem: the median over its trials, unsuccessful ones infinite;
// the upper one of an even number. Infinite for no trials.
double median_runtime(const std::vector<Trial>& trials, double precision);

// More and Wild (2009): d(kappa), the share of problems solved to tau within kappa (n + 1) evaluations,
// kappa in simplex gradients.
StepCurve data_profile(const TrialTable& table, std::size_t solver, double tau);

// Dolan and More (2002): rho(alpha), the share of problems solved to tau within alpha times the
// evaluations of the solver that is quickest on each. Problems that none solves stay in the denominator.
StepCurve performance_profile(const TrialTable& table, std::size_t solver, double tau);

}  // namespace odobench
