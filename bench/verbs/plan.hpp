// `bench plan`: which parameters a set of drives can determine, and which drives to add.
//
// Tables: standard deviation of every parameter, singular values with their directions, combinations that
// stay undetermined in words, and with --candidates the drives proposed. Throws std::invalid_argument on
// unknown drives or scenarios, DataError on a bad scenario.
#pragma once

#include "bench/verbs/verb.hpp"

namespace odobench {

VerbAction add_plan(CLI::App& app);

}  // namespace odobench
