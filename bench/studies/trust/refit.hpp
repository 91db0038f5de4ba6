// Fits to some of the recordings, or to recordings that count more than once.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "base/stop.hpp"
#include "problems/calibration/recording_costs.hpp"
#include "solvers/solve.hpp"

namespace odobench {

struct RefitOptions {
  SolverSpec solver{"lm", {}};
  Vector start;         // usually the fit to all recordings
  Vector second_start;  // tried where refit() says so; empty: none
  Budget budget{100'000};
  const SolverTable* solvers = nullptr;  // null: known_solvers()
  SolverSpec polish = {};                // goes on from what the solver found; name "": none
};

struct Refit {
  Vector z;
  double cost = 0;  // sum_n w_n J_n(z)
  std::string termination;
  bool from_second_start = false;  // that one was tried and is lower by more than 1e-9
};

// Minimises sum_n w_n J_n from the start. Where that does not end by `converged`, and where the weights leave
// recordings out that the result fits worse than the second start does (a sign of another valley), a second
// run goes from there, and the lower cost counts. Deterministic. Throws Interruption, and std::runtime_error
// with the solver's message where nothing came of it.
Refit refit(const std::shared_ptr<const RecordingCosts>& recordings, const Vector& weights,
            const RefitOptions& options, std::uint64_t seed, const Stop& stop);

}  // namespace odobench
