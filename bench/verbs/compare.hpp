// `bench compare OLD NEW`: two sets of stored runs side by side.
//
// CheckFailed when a limit is passed and the change is sure.
#pragma once

#include "bench/verbs/verb.hpp"

namespace odobench {

VerbAction add_compare(CLI::App& app);

}  // namespace odobench
