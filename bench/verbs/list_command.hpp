// `bench list solvers|problems|data [set.json]`.
#pragma once

#include "bench/console/exit_code.hpp"
#include "bench/verbs/command_options.hpp"

namespace odobench {

// Throws std::invalid_argument on anything else to list, DataError on a bad set.
ExitCode list_command(const ListOptions& options);

}  // namespace odobench
