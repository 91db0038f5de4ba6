#include "bench/studies/trust/refit.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace odobench {
namespace {

constexpr double kLower = 1e-9;  // of a cost that is not the same one with rounding

double cost_of_left_out(const RecordingCosts& recordings, const Vector& weights, const Vector& z) {
  double sum = 0;
  for (Eigen::Index n = 0; n < weights.size(); ++n)
    if (weights[n] == 0) sum += recordings[static_cast<std::size_t>(n)].cost(z);
  return sum;
}

}  // namespace

Refit refit(const std::shared_ptr<const RecordingCosts>& recordings, const Vector& weights,
            const RefitOptions& options, std::uint64_t seed, const Stop& stop) {
  const Problem problem(WeightedCalibration(recordings, weights));
  SolveOptions solve_options;
  solve_options.budget = options.budget;
  solve_options.seed = seed;
  solve_options.interrupt = stop.flag();
  solve_options.solvers = options.solvers;
  solve_options.polish = options.polish;
  const auto run = [&](const Vector& start) {
    Result result = solve(problem, options.solver, start, solve_options);
    stop.check();
    if (!result.usable())
      throw std::runtime_error(fmt::format("{}: {}", options.solver.text(), result.message));
    return result;
  };
  Result best = run(options.start);
  Refit out;
  const bool doubtful =
      best.termination != Termination::Converged ||
      cost_of_left_out(*recordings, weights, best.x) >
          cost_of_left_out(*recordings, weights,
                           options.second_start.size() > 0 ? options.second_start : options.start);
  if (options.second_start.size() > 0 && doubtful) {
    Result second = run(options.second_start);
    out.from_second_start = second.cost < best.cost * (1 - kLower);
    if (second.cost < best.cost) best = std::move(second);
  }
  out.z = best.x;
  out.cost = best.cost;
  out.termination = to_string(best.termination);
  return out;
}

}  // namespace odobench
