// `bench run`: solvers on a problem, from options to records and tables.
#pragma once

#include "bench/console/exit_code.hpp"
#include "bench/verbs/command_options.hpp"

namespace odobench {

// Tables on standard output, everything else on standard error. Throws std::invalid_argument on options that
// make no sense (nothing is run or written then), DataError on a bad set.
ExitCode run_command(const RunOptions& options);

}  // namespace odobench
