// The relative-entropy filter over a recorded run: the study behind `bench filter`.
#pragma once

#include <cstdint>

#include "base/stop.hpp"
#include "bench/catalogue/catalogue.hpp"
#include "bench/studies/entropy/entropy_output.hpp"
#include "bench/studies/entropy/entropy_setup.hpp"
#include "bench/studies/watcher.hpp"
#include "reports/records/record.hpp"

namespace odobench {

struct FilteredRun {
  RunRecord record;
  std::int64_t windows = 0;
  bool interrupted = false;
  bool unfinished = false;  // the last line of the data has no line break; it was taken
};

// Filters options.data window by window; options.out has a row of each when this returns, and is not there
// when it throws. After a stop the windows so far are the result. The watcher counts windows. Throws
// std::invalid_argument on options that make no sense, DataError "file:line: ..." on bad data, Interruption
// when no window was finished.
FilteredRun filter_run(const EntropyOptions& options, const Catalogue& catalogue,
                       const TextSink& standard_output, Watcher& watcher, const Stop& stop);

}  // namespace odobench
