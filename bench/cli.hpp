// The command line of `bench`: parses it, runs one verb, turns every failure into one line and an exit code.
#pragma once

namespace odobench {

// Returns the exit code of bench/console/exit_code.hpp.
int bench_main(int argc, char** argv);

}  // namespace odobench
