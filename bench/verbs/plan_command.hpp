// `bench plan`: which parameters a set of drives can determine, and which drives to add.
#pragma once

#include "bench/console/exit_code.hpp"
#include "bench/verbs/command_options.hpp"

namespace odobench {

// Tables: standard deviation of every parameter, singular values with their directions, combinations that stay
// undetermined in words, and with --candidates the drives proposed. Throws std::invalid_argument on unknown drives or
// scenarios, DataError on a bad scenario.
ExitCode plan_command(const PlanOptions& options);

}  // namespace odobench
