#include "bench/console/terminal_watcher.hpp"

#include "bench/console/interrupt.hpp"
#include "bench/console/table_output.hpp"

namespace odobench {

void TerminalWatcher::note(const std::string& text) {
  if (!quiet_) odobench::note(text);
}

void TerminalWatcher::warn(const std::string& text) {
  odobench::warn(text);
}

void TerminalWatcher::results_begin() {
  InterruptGuard::remember();
}

void TerminalWatcher::runs_begin(std::size_t runs, const std::function<std::string(std::size_t)>& label) {
  runs_.emplace(!quiet_, runs, label);
}

void TerminalWatcher::count_begins(const std::string& unit, std::int64_t total) {
  count_.emplace(!quiet_, unit, total);
}

}  // namespace odobench
