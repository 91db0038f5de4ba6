// How long work is asked to end early.
#pragma once

#include <atomic>
#include <stdexcept>

namespace odobench {

// Thrown to leave work that has no partial result worth keeping.
class Interruption : public std::runtime_error {
 public:
  Interruption() : std::runtime_error("interrupted") {}
};

// A flag that somebody else sets, e.g. a signal handler; without one never. Copies watch the same flag, which
// must outlive them. Cheap enough to be asked in every turn of a loop.
class Stop {
 public:
  Stop() = default;
  explicit Stop(const std::atomic<bool>& flag) : flag_(&flag) {}

  bool requested() const { return flag_ != nullptr && flag_->load(std::memory_order_relaxed); }
  // What the copies watch, for loops that ask it themselves; null: nothing.
  const std::atomic<bool>* flag() const { return flag_; }
  // Throws Interruption once the flag is set.
  void check() const {
    if (requested()) throw Interruption();
  }

 private:
  const std::atomic<bool>* flag_ = nullptr;
};

}  // namespace odobench
