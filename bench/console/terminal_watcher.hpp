// A study seen from a terminal: remarks on standard error, a status line, signals remembered in time.
#pragma once

#include <optional>

#include "bench/console/progress.hpp"
#include "bench/studies/watcher.hpp"

namespace odobench {

class TerminalWatcher final : public Watcher {
 public:
  // `quiet`: warnings only.
  explicit TerminalWatcher(bool quiet = false) : quiet_(quiet) {}

  void note(const std::string& text) override;
  void warn(const std::string& text) override;
  void results_begin() override;  // InterruptGuard::remember()
  void runs_begin(std::size_t runs, const std::function<std::string(std::size_t)>& label) override;
  void started(std::size_t run) override { runs_->started(run); }
  void progressed(std::size_t run, const Progress& progress) override { runs_->progressed(run, progress); }
  void finished(std::size_t run) override { runs_->finished(run); }
  void runs_end() override { runs_.reset(); }
  void count_begins(const std::string& unit, std::int64_t total) override;
  void count_is(std::int64_t pieces) override { count_->set(pieces); }
  void count_one() override { count_->add_one(); }
  void count_ends() override { count_.reset(); }

 private:
  const bool quiet_;
  std::optional<ProgressLine> runs_;
  std::optional<CountLine> count_;
};

}  // namespace odobench
