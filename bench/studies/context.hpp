// Where and with what a run was made: the context of a record.
#pragma once

#include <string>

#include "problems/instruction_set.hpp"
#include "reports/records/record.hpp"

namespace odobench {

RunContext run_context(int threads, InstructionSet kernel);
std::string utc_now();  // "2024-05-03T10:34:34Z"
// "bench 0.1.0 (revision 1a2b3c4d, Release, g++ 12.2.0, kernel avx2)"; the kernel is that of verbs without
// --kernel. A second line says why there are no charts, where there are none.
std::string version_line();

}  // namespace odobench
