// What the process says and returns when something goes wrong; what nobody foresaw is a fault of the program,
// not of the data.
#pragma once

#include <exception>
#include <string>

#include "bench/console/exit_code.hpp"

namespace odobench {

// What an Interruption says; a signal handler writes it, too.
inline constexpr const char* kInterrupted = "interrupted; nothing was written";

struct Ending {
  ExitCode code;
  std::string message;  // one line
};

// std::invalid_argument is wrong usage, std::runtime_error (DataError, the file system's errors) wrong data,
// an Interruption itself. All else (logic errors, no memory, what libraries throw) is an internal fault: the
// line asks for a report.
Ending ending_of(const std::exception_ptr& error);

// From now on std::terminate ends with exit code 70 and a line that says what was thrown; SIGSEGV, SIGBUS,
// SIGFPE, SIGILL and SIGABRT write such a line, a stack overflow too, and then have their usual effect. Not
// under sanitizers, which have handlers of their own.
void announce_crashes();

}  // namespace odobench
