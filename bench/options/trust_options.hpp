// Options about how far results can be trusted.
#pragma once

#include <CLI/App.hpp>

#include "bench/studies/trust/trust_choice.hpp"

namespace odobench {

// --validate.
void add_validation(CLI::App& app, ValidationChoice& choice);
// --bootstrap, --bootstrap-scheme.
void add_bootstrap(CLI::App& app, TrustChoice& choice);
// --profile, --profile-steps, --combination.
void add_profile(CLI::App& app, TrustChoice& choice);

}  // namespace odobench
