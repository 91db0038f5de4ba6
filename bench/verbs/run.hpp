// `bench run`: solvers on a problem, from options to records and tables.
//
// Tables on standard output, everything else on standard error. Throws std::invalid_argument on options that
// make no sense (nothing is run or written then), DataError on a bad set.
#pragma once

#include "bench/verbs/verb.hpp"

namespace odobench {

VerbAction add_run(CLI::App& app);

}  // namespace odobench
