// A loop on several threads whose result does not depend on them.
#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "base/stop.hpp"

namespace odobench {

// Where threads meet, in the language's own terms: what one did before it arrived is seen by all that arrive
// later. A scheduler in a library of its own orders its threads just as well, but tools that look for races
// cannot see into it. Costs an atomic addition.
class Meeting {
 public:
  void arrive() { arrived_.fetch_add(1, std::memory_order_acq_rel); }

 private:
  std::atomic<long> arrived_{0};
};

// work(0) ... work(count - 1), each once, on `threads` threads (0: as many as the machine has). After an
// exception no further index begins; that of the lowest index is passed on. A stop that is asked for between
// two indices is such an exception (Interruption).
template <class Work>
void parallel_for(std::size_t count, int threads, const Work& work, const Stop& stop = {}) {
  std::size_t most = threads > 0 ? static_cast<std::size_t>(threads) : std::thread::hardware_concurrency();
  most = std::clamp<std::size_t>(most, 1, std::max<std::size_t>(count, 1));
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr error;
  std::size_t error_index = count;
  const auto run = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        stop.check();
        work(i);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex);
        if (i < error_index) {
          error_index = i;
          error = std::current_exception();
        }
        next = count;
      }
    }
  };
  std::vector<std::thread> pool;
  for (std::size_t k = 1; k < most; ++k) pool.emplace_back(run);
  run();
  for (std::thread& thread : pool) thread.join();
  if (error) std::rethrow_exception(error);
}

}  // namespace odobench
