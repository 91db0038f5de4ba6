// `bench simulate`: drives that never were, with their truth.
//
// Of kind recordings: DIR/set.json with its recordings, or with --raw abs_i.csv, odom_i.csv and SHA256SUMS as
// `bench import vitko2024` reads them; truth.json and truth.csv beside them. Of kind dynamics: sensors.csv,
// truth.csv, state.csv and robot.json. Throws std::invalid_argument on options that do not fit the scenario
// or on files that are there already, DataError on a bad scenario.
#pragma once

#include "bench/verbs/verb.hpp"

namespace odobench {

VerbAction add_simulate(CLI::App& app);

}  // namespace odobench
