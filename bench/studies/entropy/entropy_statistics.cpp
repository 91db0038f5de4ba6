#include "bench/studies/entropy/entropy_statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

namespace odobench {
namespace {

// Of the filter's output; what it was given and the control are what they are.
Better better_at(std::string_view stage) {
  return stage == "after" ? Better::Lower : Better::None;
}

// Half of the rotation before the step and half after it: second order in the step.
void advance(Pose& pose, double sx, double sy, double rotation) {
  const double middle = pose.theta + rotation / 2;
  pose.x += sx * std::cos(middle) - sy * std::sin(middle);
  pose.y += sx * std::sin(middle) + sy * std::cos(middle);
  pose.theta += rotation;
}

}  // namespace

void Average::add(double value) {
  min_ = count_ == 0 ? value : std::min(min_, value);
  max_ = count_ == 0 ? value : std::max(max_, value);
  ++count_;
  // Compensated: a run may have millions of windows.
  const double y = value - compensation_, t = sum_ + y;
  compensation_ = (t - sum_) - y;
  sum_ = t;
}

double Average::mean() const {
  return sum_ / static_cast<double>(count_);
}

void NoiseMeter::Errors::add(double error) {
  square.add(error * error);
  magnitude.add(std::abs(error));
}

void NoiseMeter::Deviation::compare(const Pose& truth) {
  end = std::hypot(pose.x - truth.x, pose.y - truth.y);
  max = std::max(max, end);
}

NoiseMeter::NoiseMeter(const FilterSetup& setup)
    : radians_(setup.rotation_sign * std::numbers::pi / 180), predictor_(setup.constants) {}

void NoiseMeter::add_channel(std::size_t channel, double truth, std::array<double, 3> values) {
  truth_[channel].add(std::abs(truth));
  for (std::size_t stage = 0; stage < 3; ++stage) errors_[channel][stage].add(values[stage] - truth);
}

const char* NoiseMeter::stage_name(std::size_t stage) {
  return stage < kNoiseStages.size() ? kNoiseStages[stage] : kComparedStages[stage - kNoiseStages.size()];
}

// Accelerations of the linear model belong to the sample itself.
void NoiseMeter::add_compared(std::size_t stage, const TrueSample& truth, const MotionEstimate& e) {
  for (std::size_t w = 0; w < 4; ++w) {
    errors_[0][stage].add(e.wheels.x[w] - truth.x[w]);
    errors_[0][stage].add(e.wheels.y[w] - truth.y[w]);
    errors_[1][stage].add(std::hypot(e.wheels.x[w], e.wheels.y[w]) - std::hypot(truth.x[w], truth.y[w]));
  }
  errors_[2][stage].add(e.state.ax12 - truth.ax);
  errors_[3][stage].add(e.state.ay12 - truth.ay);
  errors_[4][stage].add(e.wheels.rotation - truth.rotation);
  advance(tracks_[stage].pose, e.state.sx1, e.state.sy1, radians_ * e.wheels.rotation);
}

void NoiseMeter::add(const ConvertedRow& row, const TrueSample& truth, const TrueSample& next,
                     const FilterOutput& output, const LinearEstimates* compared) {
  const EntropyState& zero = output.zero.state;
  const EntropyPrediction control = predictor_.predict(zero.sx1, zero.sy1, zero.r1);
  double raw_x = 0, raw_y = 0;
  for (std::size_t w = 0; w < 4; ++w) {
    add_channel(0, truth.x[w], {row.x[w], output.first.x[w], control.x[w]});
    add_channel(0, truth.y[w], {row.y[w], output.first.y[w], control.y[w]});
    add_channel(1, std::hypot(truth.x[w], truth.y[w]),
                {std::abs(row.sample.wheel[w]), std::hypot(output.first.x[w], output.first.y[w]),
                 std::hypot(control.x[w], control.y[w])});
    raw_x += row.x[w] / 4;
    raw_y += row.y[w] / 4;
  }
  // The sample is taken at the row, ax12 lies between it and the next: the error of each is against its own
  // truth.
  const double mean_x = (truth.ax + next.ax) / 2, mean_y = (truth.ay + next.ay) / 2;
  add_channel(2, truth.ax,
              {row.sample.ax, output.state.ax12 - mean_x + truth.ax, zero.ax12 - mean_x + truth.ax});
  add_channel(3, truth.ay,
              {row.sample.ay, output.state.ay12 - mean_y + truth.ay, zero.ay12 - mean_y + truth.ay});
  add_channel(4, truth.rotation, {row.sample.rotation, output.first.rotation, control.rotation});

  advance(true_pose_, truth.sx, truth.sy, radians_ * truth.rotation);
  advance(tracks_[0].pose, raw_x, raw_y, radians_ * row.sample.rotation);
  advance(tracks_[1].pose, output.state.sx1, output.state.sy1, radians_ * output.first.rotation);
  advance(tracks_[2].pose, zero.sx1, zero.sy1, radians_ * control.rotation);
  if (compared != nullptr) {
    add_compared(kNoiseStages.size(), truth, compared->filter);
    add_compared(kNoiseStages.size() + 1, truth, compared->smoother);
    stages_ = kStages;
  }
  for (Deviation& track : tracks_) track.compare(true_pose_);
}

void NoiseMeter::report(Measures& measures) const {
  for (std::size_t c = 0; c < kNoiseChannels.size(); ++c)
    for (std::size_t stage = 0; stage < stages_; ++stage) {
      const Errors& errors = errors_[c][stage];
      const auto put = [&](const char* measure, double value, const char* unit) {
        const char* name = stage_name(stage);
        measures.put({fmt::format("noise.{}.{}.{}", kNoiseChannels[c].id, measure, name), value, unit,
                      better_at(name), kNoiseChannels[c].id});
      };
      put("rms", std::sqrt(errors.square.mean()), kNoiseChannels[c].unit);
      if (truth_[c].mean() > 0) put("ratio", errors.magnitude.mean() / truth_[c].mean(), "");
      put("max", errors.magnitude.max(), kNoiseChannels[c].unit);
    }
  for (std::size_t stage = 0; stage < stages_; ++stage) {
    const char* name = stage_name(stage);
    measures.put({fmt::format("track.end.{}", name), tracks_[stage].end, "m", better_at(name)});
    measures.put({fmt::format("track.max.{}", name), tracks_[stage].max, "m", better_at(name)});
  }
}

void MethodMeter::add(const FilterOutput& output, std::optional<double> exact,
                      std::optional<double> relaxed) {
  iterations_.add(output.search.iterations);
  evaluations_.add(static_cast<double>(output.search.evaluations));
  iterations_sum_ += output.search.iterations;
  evaluations_sum_ += output.search.evaluations;
  hamiltonian_.add(output.hamiltonian);
  gain_.add(output.hamiltonian - output.zero.h0);
  if (exact) {
    const double gap = *exact - output.hamiltonian;
    gap_exact_.add(gap);
    histogram_.add(gap, *exact);
    at_optimum_ += gap <= kSameOptimum * std::abs(*exact) ? 1 : 0;
  }
  if (relaxed) gap_relaxed_.add(*relaxed - output.hamiltonian);
}

void MethodMeter::report(Measures& measures) const {
  if (windows() == 0) return;
  measures.put({"windows", static_cast<double>(windows()), ""});
  measures.put({"iterations_mean", iterations_.mean(), "", Better::Lower});
  measures.put({"iterations_max", iterations_.max(), "", Better::Lower});
  measures.put({"evaluations_mean", evaluations_.mean(), "", Better::Lower});
  measures.put({"hamiltonian_mean", hamiltonian_.mean(), "", Better::Higher});
  measures.put({"hamiltonian_min", hamiltonian_.min(), ""});
  measures.put({"hamiltonian_max", hamiltonian_.max(), ""});
  measures.put({"gain_mean", gain_.mean(), "", Better::Higher});
  measures.put({"gain_max", gain_.max(), "", Better::Higher});
  if (gap_exact_.count() > 0) {
    const double share = static_cast<double>(at_optimum_) / static_cast<double>(gap_exact_.count());
    measures.put({"gap_exact_mean", gap_exact_.mean(), "", Better::Lower});
    measures.put({"gap_exact_max", gap_exact_.max(), "", Better::Lower});
    measures.put({"at_optimum", share, "", Better::Higher});
  }
  if (gap_relaxed_.count() > 0) {
    measures.put({"gap_relaxed_mean", gap_relaxed_.mean(), "", Better::Lower});
    measures.put({"gap_relaxed_max", gap_relaxed_.max(), "", Better::Lower});
  }
}

}  // namespace odobench
