// `bench check`: what moved in stored records, without running anything.
//
// Prints what moved against the baseline; CheckFailed when something did. With `update` writes the baseline
// instead, keeping the tolerances of the one that is there, those of single entries included.
#pragma once

#include "bench/verbs/verb.hpp"

namespace odobench {

VerbAction add_check(CLI::App& app);

}  // namespace odobench
