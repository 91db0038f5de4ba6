// The linear Kalman filter and smoother beside the relative-entropy filter: same rows, same truth, processor
// time of each.
#pragma once

#include <ctime>

#include "bench/studies/entropy/entropy_statistics.hpp"
#include "problems/kalman/encoder_smoother.hpp"

namespace odobench {

// Processor time of this thread, summed over calls, without what reading the clock takes.
class CpuMeter {
 public:
  CpuMeter();
  void begin() { begin_ = now(); }
  void end() {
    sum_ += now() - begin_ - overhead_;
    ++count_;
  }
  double mean() const { return count_ == 0 ? 0 : sum_ / static_cast<double>(count_); }  // s

 private:
  static double now();
  double begin_ = 0, sum_ = 0, overhead_ = 0;
  std::int64_t count_ = 0;
};

class LinearComparison {
 public:
  explicit LinearComparison(const ProfileForm& profile);

  // Every row in its order. `entropy` measures what the filter takes for it: begin() before, end() after.
  CpuMeter& entropy() { return entropy_; }
  void push(const EntropySample& sample);
  // Of the first sample of the window that the last row completes: what the filter said of it when it came,
  // and what the smoother says of it now, as many samples late as the relative-entropy filter.
  LinearEstimates estimates() const { return {filtered_[0], smoothed_}; }
  // cpu.after, cpu.kalman, cpu.smoother: microseconds per sample. The smoother needs the filter: its time
  // includes it.
  void report(Measures& measures) const;

 private:
  EncoderSmoother smoother_;
  LastOf<MotionEstimate> filtered_;
  MotionEstimate smoothed_;
  CpuMeter entropy_, filter_, back_;
};

}  // namespace odobench
