#include "bench/studies/work_size.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace odobench {

void require_size(const WorkSize& size) {
  const auto refuse = [&size](double samples, double most, const char* how) {
    if (!(samples <= most))
      throw std::invalid_argument(fmt::format(
          "{}: about {:.3g} samples{}, expected at most {:.3g}: shorter or fewer drives, or lower "
          "rates",
          size.what, samples, how, most));
  };
  refuse(size.held, kMostSamplesHeld, " in memory at once");
  refuse(size.made, kMostSamplesMade, "");
}

void announce(const std::string& text, double seconds, Watcher& watcher) {
  if (seconds < kLong_s) return;
  watcher.note(fmt::format("{}: {:.2g} minutes of one processor", text, seconds / 60));
}

void announce(const WorkSize& size, Watcher& watcher) {
  announce(fmt::format("{}: about {:.2g} samples", size.what, size.made), size.made * kSecondsPerSample,
           watcher);
}

}  // namespace odobench
