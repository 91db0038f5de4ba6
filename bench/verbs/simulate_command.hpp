// `bench simulate`: drives that never were, with their truth.
#pragma once

#include "bench/console/exit_code.hpp"
#include "bench/verbs/command_options.hpp"
#include "reports/render/table.hpp"

namespace odobench {

// Of kind recordings: DIR/set.json with its recordings, or with --raw abs_i.csv, odom_i.csv and SHA256SUMS as
// `bench import vitko2024` reads them; truth.json and truth.csv beside them. Of kind dynamics: sensors.csv, truth.csv,
// state.csv and robot.json. Throws std::invalid_argument on options that do not fit the scenario or on files that are
// there already, DataError on a bad scenario.
ExitCode simulate_command(const SimulateOptions& options);

// `bench list scenarios [SCENARIO]`: what there is, or one in detail.
std::vector<Table> scenario_tables(const std::string& scenario);

}  // namespace odobench
