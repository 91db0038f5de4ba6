// How large the errors of a calibration are on recordings that its fit has not seen.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "bench/studies/trust/fold_plan.hpp"
#include "bench/studies/trust/refit.hpp"
#include "bench/studies/watcher.hpp"
#include "reports/kinds/trust/validation_record.hpp"

namespace odobench {

struct ValidationOptions {
  SolverSpec solver{"lm", {}};
  Budget budget{100'000};
  const SolverTable* solvers = nullptr;  // null: known_solvers()
  SolverSpec polish = {};                // goes on from what the solver found; name "": none
  std::uint64_t seed = 1;                // of solvers that draw random numbers
  int threads = 0;                       // 0: one per core; no result depends on it
  // Where the fits begin. The fit to all recordings begins at `start`; those of the folds at the fit to all
  // recordings, with a second run from `second_start` where refit() says so.
  Vector start, second_start;
};

struct Validation {
  Refit full;  // to all recordings
  std::vector<SchemeFigures> schemes;
};

// Fits to all recordings, then once per fold to all but those that the fold leaves out, and judges each
// recording by the fit that has not seen it. Plans without folds give nothing. No recording is prepared
// again. The prediction of predicted_held_out_cost() goes with "repetitions", where every recording is
// judged. The watcher is told of every fold. Throws Interruption, and what refit() throws.
Validation validate(const std::shared_ptr<const RecordingCosts>& recordings,
                    const std::vector<FoldPlan>& plans, const ValidationOptions& options, Watcher& watcher,
                    const Stop& stop = {});

// The same with recordings that are prepared here, and nominal parameters as both starts.
Validation validate(const Robot& robot, std::span<const Recording> recordings,
                    const CalibrationOptions& calibration, const std::vector<FoldPlan>& plans,
                    const ValidationOptions& options = {}, const Stop& stop = {});

std::vector<DriveName> drive_names(std::span<const Recording> recordings);
std::vector<DriveName> drive_names(const RecordingCosts& recordings);

Vector nominal_of(const std::vector<ParameterInfo>& parameters);

}  // namespace odobench
