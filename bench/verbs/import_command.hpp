// `bench import` and `bench demo`: data sets from raw files and from the generator.
#pragma once

#include "bench/console/exit_code.hpp"
#include "bench/verbs/command_options.hpp"

namespace odobench {

// Throws std::invalid_argument on an unknown source or a set that is there already, DataError with file:line
// on bad raw files, Interruption on Ctrl-C; nothing is written then.
ExitCode import_command(const ImportOptions& options);

ExitCode demo_command(const DemoOptions& options);

}  // namespace odobench
