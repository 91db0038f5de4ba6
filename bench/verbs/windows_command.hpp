// `bench windows`: the windows of a file solved by several methods, compared.
#pragma once

#include "bench/console/exit_code.hpp"
#include "bench/verbs/command_options.hpp"

namespace odobench {

// Throws std::invalid_argument on wrong usage, DataError on a bad file. Ctrl-C keeps what is complete, like
// `bench run`.
ExitCode windows_command(const WindowsOptions& options);

}  // namespace odobench
