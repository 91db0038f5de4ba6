// How the process ends. docs/cli.md states the same list for users.
#pragma once

namespace odobench {

enum class ExitCode : int {
  Success = 0,
  // `bench inspect` found an error, `bench check` a difference, or not one solver of `bench run` a result.
  CheckFailed = 1,
  Usage = 2,  // the command line, a configuration file or an output place is wrong (std::invalid_argument)
  Data = 3,   // a data set, record or parameter file is wrong (DataError, std::runtime_error)
  Internal = 70,     // something that nobody foresaw: a fault of the program (EX_SOFTWARE)
  Interrupted = 130  // SIGINT, SIGTERM or SIGHUP; what was complete is kept
};

}  // namespace odobench
