#include "bench/console/interrupt.hpp"

#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <ctime>

#include "bench/console/exit_code.hpp"
#include "bench/console/faults.hpp"

namespace odobench {
namespace {

constexpr std::array<int, 3> kEndingSignals{SIGINT, SIGTERM, SIGHUP};
constexpr std::int64_t kSameWish_ns = 250'000'000;

// A signal handler can reach nothing but globals; these are the process's.
enum class Phase { NothingWritten, Remembered, Ending };
std::atomic<Phase> phase{Phase::NothingWritten};
std::atomic<bool> interrupted{false}, terminal{false};
std::array<std::atomic<std::int64_t>, kEndingSignals.size()> first_ns{};  // when a kind came; 0: not yet
static_assert(std::atomic<Phase>::is_always_lock_free && std::atomic<std::int64_t>::is_always_lock_free,
              "a signal handler may touch only lock-free atomics");
std::array<struct sigaction, kEndingSignals.size()> previous;

std::int64_t now_ns() {
  timespec t{};
  ::clock_gettime(CLOCK_MONOTONIC, &t);
  return static_cast<std::int64_t>(t.tv_sec) * 1'000'000'000 + t.tv_nsec + 1;
}

[[noreturn]] void end_at_once() {
  char line[128] = "";
  if (terminal.load(std::memory_order_relaxed)) std::strcat(line, "\r\x1b[K");  // of a progress line
  std::strcat(line, "bench: error: ");
  std::strcat(line, kInterrupted);
  std::strcat(line, "\n");
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, line, std::strlen(line));
  ::_exit(static_cast<int>(ExitCode::Interrupted));
}

extern "C" void odobench_on_signal(int signal) {
  Phase now_in = Phase::NothingWritten;
  if (phase.compare_exchange_strong(now_in, Phase::Ending) || now_in == Phase::Ending) end_at_once();
  interrupted.store(true, std::memory_order_relaxed);
  for (std::size_t i = 0; i < kEndingSignals.size(); ++i) {
    if (kEndingSignals[i] != signal) continue;
    std::int64_t first = 0;
    const std::int64_t now = now_ns();
    if (first_ns[i].compare_exchange_strong(first, now) || now - first < kSameWish_ns) return;
  }
  struct sigaction action = {};
  action.sa_handler = SIG_DFL;
  sigemptyset(&action.sa_mask);
  ::sigaction(signal, &action, nullptr);
  ::raise(signal);  // delivered when this handler returns
}

}  // namespace

InterruptGuard::InterruptGuard() {
  interrupted.store(false);
  phase.store(Phase::NothingWritten);
  terminal.store(::isatty(STDERR_FILENO) == 1);
  struct sigaction action = {};
  action.sa_handler = odobench_on_signal;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < kEndingSignals.size(); ++i) {
    first_ns[i].store(0);
    ::sigaction(kEndingSignals[i], nullptr, &previous[i]);
    if (kEndingSignals[i] == SIGHUP && previous[i].sa_handler == SIG_IGN) continue;
    ::sigaction(kEndingSignals[i], &action, nullptr);
  }
}

InterruptGuard::~InterruptGuard() {
  phase.store(Phase::Remembered);
  for (std::size_t i = 0; i < kEndingSignals.size(); ++i)
    if (previous[i].sa_handler != SIG_DFL) ::sigaction(kEndingSignals[i], &previous[i], nullptr);
}

void InterruptGuard::remember() {
  Phase before = Phase::NothingWritten;
  if (!phase.compare_exchange_strong(before, Phase::Remembered) && before == Phase::Ending)
    for (;;) ::pause();  // another thread is ending the process
}

const std::atomic<bool>& InterruptGuard::flag() {
  return interrupted;
}

}  // namespace odobench
