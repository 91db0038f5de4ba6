// `bench evaluate`: J and error tables of given parameters.
//
// Parameters outside the box are evaluated with a warning on standard error.
#pragma once

#include "bench/verbs/verb.hpp"

namespace odobench {

VerbAction add_evaluate(CLI::App& app);

}  // namespace odobench
