// `bench demo`: the demo data set, made anew.
#pragma once

#include "bench/verbs/verb.hpp"

namespace odobench {

VerbAction add_demo(CLI::App& app);

}  // namespace odobench
