// `bench windows`: the windows of a file solved by several methods, compared.
//
// Throws std::invalid_argument on wrong usage, DataError on a bad file. Ctrl-C keeps what is complete, like
// `bench run`.
#pragma once

#include "bench/verbs/verb.hpp"

namespace odobench {

VerbAction add_windows(CLI::App& app);

}  // namespace odobench
