// `bench run`: solvers on a problem, from options to records and tables.
#pragma once

#include "bench/command_options.hpp"
#include "bench/exit_code.hpp"

namespace odobench {

// Tables on standard output, everything else on standard error. Throws std::invalid_argument on options that
// make no sense (nothing is run or written then), DataError on a bad set.
ExitCode run_command(const RunOptions& options);

}  // namespace odobench
