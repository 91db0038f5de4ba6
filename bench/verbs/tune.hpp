// `bench tune`: the noise parameters of a filter, fitted by solvers on the first drive of each trajectory and
// judged on the others.
#pragma once

#include "bench/verbs/verb.hpp"

namespace odobench {

VerbAction add_tune(CLI::App& app);

}  // namespace odobench
