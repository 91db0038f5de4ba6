// Solvers on problems: the study behind `bench run`.
#pragma once

#include <cstdint>
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
  CalibrationChoice calibration;
  int repeat = 1;
  std::uint64_t seed = 1;
  bool random_start = false;
  std::string start_method;  // a classical method whose result is the start; empty: none
  ClassicalChoice classical;
  std::vector<std::string> accept;  // kinds of findings that do not stop a calibration, comma lists
  Budget budget{kDefaultMaxEvaluations};
  int threads = 0;                       // 0: one per core
  std::optional<InstructionSet> kernel;  // none: kernel_in_force() knows
  bool check_derivatives = false;        // before the runs, which begin only where derivatives agree
};

struct SolverRuns {
  // The nominal parameters of every calibration and its classical methods, then the runs that were made,
  // solver by solver.
  std::vector<RunRecord> records;
  std::size_t planned = 0;  // runs, with those that an interruption left out
  bool interrupted = false;
  std::optional<DerivativeTable> derivatives;
};

// Runs every solver on every problem, `threads` runs at a time; records do not depend on it. The folder gets
// each record as its run ends, in the end all in their order and the tracks of what tables show. After a stop
// no further run begins; those that have begun end early and are recorded. Throws std::invalid_argument on
// what makes no sense (nothing is run or written then), DataError on a bad set and on a start that does not
// apply to it.
SolverRuns run_solvers(const SolverStudy& study, const Catalogue& catalogue, RunFolder& folder,
                       Watcher& watcher, const Stop& stop);

}  // namespace odobench
