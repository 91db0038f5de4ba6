// `bench fuse`: wheel odometry of several parameter sets with several filters and synthetic sensors,
// compared.
#pragma once

#include "bench/verbs/verb.hpp"

namespace odobench {

VerbAction add_fuse(CLI::App& app);

}  // namespace odobench
