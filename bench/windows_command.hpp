// `bench windows`: the windows of a file solved by several methods, compared.
#pragma once

#include "bench/command_options.hpp"
#include "bench/exit_code.hpp"

namespace odobench {

// Throws std::invalid_argument on wrong usage, DataError on a bad file. Ctrl-C keeps what is complete, like
// `bench run`.
ExitCode windows_command(const WindowsOptions& options);

}  // namespace odobench
