// `bench filter`: the relative-entropy filter over a whole recorded run, row by row.
//
// Throws std::invalid_argument on wrong usage, DataError with file:line on bad data; no file is left then.
// Ctrl-C ends the run after the window at hand: file, record and tables hold the windows so far, Interrupted
// is returned; before the first window Interruption is thrown.
#pragma once

#include "bench/verbs/verb.hpp"

namespace odobench {

VerbAction add_filter(CLI::App& app);

}  // namespace odobench
