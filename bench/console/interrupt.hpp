// Ctrl-C, SIGTERM and SIGHUP (a closed terminal): before anything is written they end the process, after that
// they are a flag.
#pragma once

#include <atomic>

#include "base/stop.hpp"

namespace odobench {

// While one lives, SIGINT, SIGTERM and SIGHUP end the process at once with ExitCode::Interrupted and the line
// of an Interruption: from the first instruction of a verb on, whatever it computes or reads. A verb calls
// remember() before it creates its first file. Handlers that others had set come back at the guard's end; the
// default ones do not, since a program that is through should not be ended by a signal while it puts its
// things away. One at a time. A SIGHUP that is ignored when the guard is made (nohup) stays ignored.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  // From here on signals only set flag(), each kind once: the next one of the same kind, a quarter of a
  // second later or more, has its default effect. Sooner it is the same wish told twice: `timeout` signals
  // the process and then its group, a closed terminal both the group of the shell and that in front.
  static void remember();
  static const std::atomic<bool>& flag();
  static Stop stop() { return Stop(flag()); }
};

}  // namespace odobench
