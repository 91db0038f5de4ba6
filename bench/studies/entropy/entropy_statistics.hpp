// What `bench filter` measures while windows go by; memory does not depend on how many.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/pose.hpp"
#include "bench/studies/entropy/entropy_setup.hpp"
#include "bench/studies/entropy/entropy_signals.hpp"
#include "problems/entropy/sliding_filter.hpp"
#include "problems/kalman/encoder_smoother.hpp"
#include "reports/kinds/entropy/entropy_tables.hpp"

namespace odobench {

// The last `size` of what was pushed; [0] is the oldest.
template <class T>
class LastOf {
 public:
  explicit LastOf(std::size_t size) : items_(size) {}
  void push(const T& item) {
    items_[next_] = item;
    next_ = (next_ + 1) % items_.size();
  }
  const T& operator[](std::size_t age) const { return items_[(next_ + age) % items_.size()]; }

 private:
  std::vector<T> items_;
  std::size_t next_ = 0;
};

class Average {
 public:
  void add(double value);
  std::int64_t count() const { return count_; }
  double mean() const;
  double max() const { return max_; }
  double min() const { return min_; }

 private:
  std::int64_t count_ = 0;
  double sum_ = 0, compensation_ = 0, min_ = 0, max_ = 0;
};

// Of one sample by the linear filter and by the linear smoother.
struct LinearEstimates {
  MotionEstimate filter, smoother;
};

// Errors of every channel before and after the filter and after the filter without increments, and of the
// dead reckoning with each, against the truth. The figures are those of
// reports/kinds/entropy/entropy_tables.hpp.
class NoiseMeter {
 public:
  explicit NoiseMeter(const FilterSetup& setup);
  // The first row of the window, the truth of it and of the row after it, the filter's output, and what is
  // compared with it (null: nothing; of all windows or of none).
  void add(const ConvertedRow& row, const TrueSample& truth, const TrueSample& next,
           const FilterOutput& output, const LinearEstimates* compared = nullptr);
  void report(Measures& measures) const;

 private:
  struct Errors {
    Average square, magnitude;
    void add(double error);
  };
  struct Deviation {
    Pose pose;
    double end = 0, max = 0;
    void compare(const Pose& truth);
  };
  static constexpr std::size_t kStages = kNoiseStages.size() + kComparedStages.size();
  static const char* stage_name(std::size_t stage);
  void add_channel(std::size_t channel, double truth, std::array<double, 3> values);
  void add_compared(std::size_t stage, const TrueSample& truth, const MotionEstimate& estimate);

  double radians_;  // counter-clockwise, of one degree of the model's rotation
  Predictor predictor_;
  std::array<std::array<Errors, kStages>, kNoiseChannels.size()> errors_{};  // channel, stage
  std::array<Average, kNoiseChannels.size()> truth_{};                       // |truth|
  Pose true_pose_;
  std::array<Deviation, kStages> tracks_{};
  std::size_t stages_ = kNoiseStages.size();  // that there is something of
};

// Effort, H and gaps of the method.
class MethodMeter {
 public:
  // `exact`, `relaxed`: H at the other two optima, where they were computed.
  void add(const FilterOutput& output, std::optional<double> exact, std::optional<double> relaxed);
  std::int64_t windows() const { return hamiltonian_.count(); }
  std::int64_t iterations() const { return iterations_sum_; }
  std::int64_t evaluations() const { return evaluations_sum_; }
  const GapHistogram& histogram() const { return histogram_; }
  double hamiltonian_mean() const { return hamiltonian_.mean(); }
  void report(Measures& measures) const;

 private:
  Average iterations_, evaluations_, hamiltonian_, gain_, gap_exact_, gap_relaxed_;
  GapHistogram histogram_;
  std::int64_t iterations_sum_ = 0, evaluations_sum_ = 0, at_optimum_ = 0;
};

}  // namespace odobench
