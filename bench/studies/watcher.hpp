// What a study tells whoever called it, while it works. Nothing of it changes a result.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "solvers/run.hpp"

namespace odobench {

// Every member may be left as it is. Those about runs and counts come from the threads that work:
// implementations lock.
class Watcher {
 public:
  virtual ~Watcher() = default;

  // A sentence without a full stop. Notes are for whoever has time, warnings for everybody.
  virtual void note(const std::string& /*text*/) {}
  virtual void warn(const std::string& /*text*/) {}
  // Before the first file is written or the first run begins whose result is kept. Until then nothing is lost
  // when the process ends; from here on a study ends by its Stop, and keeps what is finished.
  virtual void results_begin() {}

  // Runs of solvers, numbered from 0. `label` lives until runs_end().
  virtual void runs_begin(std::size_t /*runs*/, const std::function<std::string(std::size_t)>& /*label*/) {}
  virtual void started(std::size_t /*run*/) {}
  virtual void progressed(std::size_t /*run*/, const Progress& /*progress*/) {}
  virtual void finished(std::size_t /*run*/) {}
  virtual void runs_end() {}

  // Other work that comes in pieces: "points", "drives". `total` 0: not known.
  virtual void count_begins(const std::string& /*unit*/, std::int64_t /*total*/) {}
  virtual void count_is(std::int64_t /*pieces*/) {}
  virtual void count_one() {}
  virtual void count_ends() {}
};

}  // namespace odobench
