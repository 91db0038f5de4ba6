// The program as a function of this process: a thousand runs in the time that starting it ten times takes,
// and sanitized where the tests are.
#pragma once

#include "tests/support/run_process.hpp"

namespace odobench::testing {

// bench with these arguments, standard output and error caught. Not for several threads at a time.
ProcessResult bench_in_process(const std::vector<std::string>& arguments);

}  // namespace odobench::testing
