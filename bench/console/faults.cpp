#include "bench/console/faults.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <new>
#include <stdexcept>

#include "base/stop.hpp"

namespace odobench {
namespace {

// A sanitizer's own handlers say more than ours.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

constexpr const char* kReport =
    "please report it with this line, the command line, what 'bench --version' prints and, if you can, the "
    "input";

Ending internal_fault(const std::string& what) {
  return {ExitCode::Internal, fmt::format("internal fault: {}; {}", what, kReport)};
}

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

// Only what a signal handler may do.
void say(const char* text) {
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text, std::strlen(text));
}

[[noreturn]] void terminated() {
  try {
    std::string line = "internal fault: ended without an exception";
    if (const std::exception_ptr error = std::current_exception()) line = ending_of(error).message;
    line = fmt::format("bench: error: {}\n", one_line(std::move(line)));
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, line.data(), line.size());
  } catch (...) {  // no memory even for the line
    say("bench: error: internal fault: no memory is left; ");
    say(kReport);
    say("\n");
  }
  std::_Exit(static_cast<int>(ExitCode::Internal));
}

struct Crash {
  int signal;
  const char* name;
};
constexpr std::array<Crash, 5> kCrashes{{{SIGSEGV, "SIGSEGV, a bad address"},
                                         {SIGBUS, "SIGBUS, a bad address or a file that shrank"},
                                         {SIGFPE, "SIGFPE, a bad arithmetic operation"},
                                         {SIGILL, "SIGILL, an unknown instruction"},
                                         {SIGABRT, "SIGABRT"}}};

void crashed(int signal) {
  say("\nbench: error: internal fault: the program was ended by ");
  for (const Crash& crash : kCrashes)
    if (crash.signal == signal) say(crash.name);
  say("; ");
  say(kReport);
  say("\n");
  ::raise(signal);  // with its default effect: SA_RESETHAND
}

}  // namespace

Ending ending_of(const std::exception_ptr& error) {
  try {
    std::rethrow_exception(error);
  } catch (const Interruption&) {
    return {ExitCode::Interrupted, kInterrupted};
  } catch (const std::invalid_argument& e) {
    return {ExitCode::Usage, e.what()};
  } catch (const std::runtime_error& e) {
    return {ExitCode::Data, e.what()};
  } catch (const std::bad_alloc&) {
    return internal_fault("no memory is left (less data, fewer threads or a higher limit may help)");
  } catch (const std::exception& e) {
    return internal_fault(e.what());
  } catch (...) {
    return internal_fault("something was thrown that is no exception");
  }
}

void announce_crashes() {
  if (kSanitized) return;
  std::set_terminate(terminated);
  static std::array<char, 1 << 16> stack;  // a handler of a stack overflow needs one of its own
  stack_t own{};
  own.ss_sp = stack.data();
  own.ss_size = stack.size();
  if (::sigaltstack(&own, nullptr) != 0) return;
  for (const Crash& crash : kCrashes) {
    struct sigaction action {};
    action.sa_handler = crashed;
    action.sa_flags = SA_ONSTACK | static_cast<int>(SA_RESETHAND) | SA_NODEFER;
    ::sigemptyset(&action.sa_mask);
    ::sigaction(crash.signal, &action, nullptr);
  }
}

}  // namespace odobench
