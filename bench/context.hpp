// Where and with what a run was made: the context of a record.
#pragma once

#include <string>

#include "reports/record.hpp"

namespace odobench {

RunContext run_context(int threads);
std::string utc_now();  // "2024-05-03T10:34:34Z"
// "bench 0.1.0 (revision 1a2b3c4d, Release, g++ 12.2.0)"
std::string version_line();

}  // namespace odobench
