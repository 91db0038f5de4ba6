// `bench import`: data sets from raw files.
//
// Throws std::invalid_argument on an unknown source or a set that is there already, DataError with file:line
// on bad raw files, Interruption on Ctrl-C; nothing is written then.
#pragma once

#include "bench/verbs/verb.hpp"

namespace odobench {

VerbAction add_import(CLI::App& app);

}  // namespace odobench
