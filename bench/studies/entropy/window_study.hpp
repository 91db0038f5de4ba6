// Solvers on stored windows of the relative-entropy filter: the study behind `bench windows`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/stop.hpp"
#include "bench/catalogue/catalogue.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/studies/run_folder.hpp"
#include "bench/studies/watcher.hpp"
#include "solvers/run.hpp"

namespace odobench {

struct WindowStudy {
  std::string file;                  // JSON of the format entropy-window-1
  std::vector<std::string> solvers;  // each a comma list as typed; empty: coordinate,exact,relaxed
  std::vector<std::string> only;     // comma lists of ids or groups; empty: all windows
  int repeat = 1;                    // runs of every solver that draws random numbers
  std::uint64_t seed = 1;
  int threads = 0;  // 0: one per core
  std::optional<InstructionSet> kernel;
  Budget budget{kDefaultMaxEvaluations};
};

struct WindowRuns {
  std::vector<RunRecord> records;  // window by window, in each solver by solver
  std::size_t planned = 0;         // runs, with those that an interruption left out
  bool interrupted = false;
};

// Runs every solver on every window. A record compares the result with the window's true optimum, that of the
// relaxation and zero increments. The folder gets each record as its run ends. After a stop no further run
// begins. Throws std::invalid_argument on names that are none, DataError on a bad file, Interruption when no
// run was made.
WindowRuns run_on_windows(const WindowStudy& study, const Catalogue& catalogue, RunFolder& folder,
                          Watcher& watcher, const Stop& stop);

}  // namespace odobench
