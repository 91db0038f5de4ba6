#include "problems/trust/recordings_apart.hpp"

namespace odobench {

std::shared_ptr<const RecordingCosts> RecordingsApart::get() const {
  constexpr std::size_t kMostKept = 2'000'000;
  const std::lock_guard lock(mutex_);
  if (kept_) return kept_;
  auto made = std::make_shared<const RecordingCosts>(robot_, problem_->recordings(), problem_->options(),
                                                     problem_->kernel());
  std::size_t samples = 0;
  for (const Recording& r : problem_->recordings()) samples += r.size();
  if (samples <= kMostKept) kept_ = made;
  return made;
}

}  // namespace odobench
