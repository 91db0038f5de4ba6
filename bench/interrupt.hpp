// Ctrl-C and SIGTERM as a flag that runs poll; a second one ends the process at once.
#pragma once

#include <atomic>

namespace odobench {

// While one lives, SIGINT and SIGTERM set flag() instead of ending the process; each signal only once, the
// next one of the same kind has its default effect again. The previous handlers come back at its end. One at
// a time.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;
  static const std::atomic<bool>& flag();
};

}  // namespace odobench
