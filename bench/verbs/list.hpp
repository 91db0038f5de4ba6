// `bench list solvers|problems|data [set.json]`.
//
// Throws std::invalid_argument on anything else to list, DataError on a bad set.
#pragma once

#include "bench/verbs/verb.hpp"

namespace odobench {

VerbAction add_list(CLI::App& app);

}  // namespace odobench
