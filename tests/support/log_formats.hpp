// Formats of logs, for mutations and fuzzing: small examples, and the commands that read them.
#pragma once

#include <vector>

#include "tests/support/formats.hpp"

namespace odobench::testing {

std::vector<Format> log_formats_read();

}  // namespace odobench::testing
