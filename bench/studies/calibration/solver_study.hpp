// Solvers on problems: the study behind `bench run`.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/stop.hpp"
#include "bench/catalogue/catalogue.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/studies/calibration/classical_study.hpp"
#include "bench/studies/calibration/derivative_table.hpp"
#include "bench/studies/run_folder.hpp"
#include "bench/studies/watcher.hpp"
#include "solvers/run.hpp"

namespace odobench {

struct SolverStudy {
  std::vector<std::string> solvers;   // each a comma list as typed; empty: lm,ip,ga,pso
  std::string polish;                 // solver as typed; empty: none
  std::vector<std::string> problems;  // each a comma list of names and patterns; empty: calibration
  int dimension = 0;                  // of classic problems; 0: their usual ones
  std::string data;                   // path of set.json of the calibration; empty: the demo set
  // Recordings that differ from their siblings are left out unless calibration.screen is 0.
  CalibrationChoice calibration = screened();
  int repeat = 1;
  std::uint64_t seed = 1;
  bool random_start = false;
  bool nominal_start = false;  // even where the loss has a better one
  std::string start_method;    // a classical method whose result is the start; empty: none
  ClassicalChoice classical;
  std::vector<std::string> accept;  // kinds of findings that do not stop a calibration, comma lists
  Budget budget{kDefaultMaxEvaluations};
  int threads = 0;                       // 0: one per core
  std::optional<InstructionSet> kernel;  // none: kernel_in_force() knows
  bool resume = false;                   // runs that the folder has are kept
  bool check_derivatives = false;        // before the runs, which begin only where derivatives agree
  // Called with the run of lowest J of each calibration: puts what it finds into the record and returns
  // remarks on it.
  std::function<std::vector<std::string>(const LoadedProblem&, RunRecord&)> describe;
  // What else there is to say of finished runs. Neither is called when it is empty.
  // Before the first run, to refuse (std::invalid_argument) what these problems do not have.
  std::function<void(const std::vector<LoadedProblem>&)> require;
  // When all runs ended by themselves, before their records are kept for good; returns whether it changed
  // any.
  std::function<bool(const std::vector<LoadedProblem>&, std::vector<RunRecord>&)> judge;
};

struct SolverRuns {
  // The nominal parameters of every calibration and its classical methods, then the runs that were made,
  // solver by solver.
  std::vector<RunRecord> records;
  std::size_t kept = 0;     // of a folder that goes on
  std::size_t planned = 0;  // runs, with those that an interruption left out
  bool interrupted = false;
  std::optional<DerivativeTable> derivatives;
};

// Runs every solver on every problem, `threads` runs at a time, or those of them that are missing in a
// folder that goes on (by record_key()); records do not depend on it. The folder gets each record as its run
// ends, in the end all in their order and the tracks of what tables show. After a stop no further run
// begins; those that have begun end early and are recorded. Throws std::invalid_argument on what makes no
// sense (nothing is run or written then), DataError on a bad set and on a start that does not apply to it.
SolverRuns run_solvers(const SolverStudy& study, const Catalogue& catalogue, RunFolder& folder,
                       Watcher& watcher, const Stop& stop);

}  // namespace odobench
