// Work in child processes: one that crashes, hangs or takes too much memory costs its piece only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "base/stop.hpp"

namespace odobench {

struct IsolationLimits {
  double seconds = 0;        // of wall clock for each piece; 0: none
  std::uint64_t memory = 0;  // bytes of address space of a child; 0: none. Not under address sanitizers.
};

// "60", "time=60,memory=2G": of the option --isolate; "" is no limit. Throws std::invalid_argument.
IsolationLimits parse_isolation(const std::string& option, const std::string& text);

class IsolatedWork {
 public:
  virtual ~IsolatedWork() = default;
  // In a child: the bytes that tell the result, or nothing where the piece was stopped.
  virtual std::optional<std::string> run(std::size_t piece) = 0;
  // In the caller's process: the piece begins; what it gave; why it gave nothing ("ended by signal 11
  // (Segmentation fault)", "took longer than 5 s").
  virtual void started(std::size_t piece) = 0;
  virtual void finished(std::size_t piece, const std::string& bytes) = 0;
  virtual void failed(std::size_t piece, const std::string& reason) = 0;
  // After some have finished or failed.
  virtual void settled() = 0;
};

// Pieces 0 ... count - 1, in this order, in `processes` children that take one after the other: copies of
// this process, which must have no other thread. Children end with this process, however it ends. After
// `stop` those that run are ended and their pieces dropped. An exception of the caller's side ends it, too.
void run_isolated(std::size_t count, int processes, const IsolationLimits& limits, const Stop& stop,
                  IsolatedWork& work);

}  // namespace odobench
