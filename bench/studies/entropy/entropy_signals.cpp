#include "bench/studies/entropy/entropy_signals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace odobench {

void SignalEnvelope::add(std::span<const double> values) {
  if (rows_ % width_ != 0) {
    double* low = &low_[low_.size() - signals_];
    double* high = &high_[high_.size() - signals_];
    for (std::size_t s = 0; s < signals_; ++s) {
      low[s] = std::min(low[s], values[s]);
      high[s] = std::max(high[s], values[s]);
    }
  } else {
    if (buckets() == kMost) halve();
    low_.insert(low_.end(), values.begin(), values.end());
    high_.insert(high_.end(), values.begin(), values.end());
  }
  ++rows_;
}

// Called with an even number of full buckets, so that the next row begins a new one at either width.
void SignalEnvelope::halve() {
  const std::size_t half = buckets() / 2;
  for (std::size_t b = 0; b < half; ++b)
    for (std::size_t s = 0; s < signals_; ++s) {
      low_[b * signals_ + s] = std::min(low(2 * b, s), low(2 * b + 1, s));
      high_[b * signals_ + s] = std::max(high(2 * b, s), high(2 * b + 1, s));
    }
  low_.resize(half * signals_);
  high_.resize(half * signals_);
  width_ *= 2;
}

SignalMeter::SignalMeter(bool with_truth)
    : with_truth_(with_truth), envelope_(kSignals.size() * kSignalStages.size()), detail_() {
  detail_.resize(kSignals.size() * kSignalStages.size());
}

void SignalMeter::add(const ConvertedRow& row, const FilterOutput& output, const TrueSample* truth,
                      const TrueSample* next) {
  double before = 0, after = 0, real = 0;
  for (std::size_t w = 0; w < 4; ++w) {
    before += std::abs(row.sample.wheel[w]) / 4;
    after += std::hypot(output.first.x[w], output.first.y[w]) / 4;
    if (with_truth_) real += std::hypot(truth->x[w], truth->y[w]) / 4;
  }
  std::array<double, kSignals.size() * kSignalStages.size()> values{before,
                                                                    after,
                                                                    real,
                                                                    row.sample.ax,
                                                                    output.state.ax12,
                                                                    0,
                                                                    row.sample.ay,
                                                                    output.state.ay12,
                                                                    0,
                                                                    row.sample.rotation,
                                                                    output.first.rotation,
                                                                    0};
  if (with_truth_) {  // ax12 lies between this row and the next
    values[5] = (truth->ax + next->ax) / 2;
    values[8] = (truth->ay + next->ay) / 2;
    values[11] = truth->rotation;
  }
  envelope_.add(values);
  if (detail_.front().size() < kDetail)
    for (std::size_t s = 0; s < values.size(); ++s) detail_[s].push_back(values[s]);
}

void SignalMeter::report(std::map<std::string, std::vector<double>>& series) const {
  if (envelope_.buckets() == 0) return;
  series["signal.width"] = {static_cast<double>(envelope_.width())};
  for (std::size_t c = 0; c < kSignals.size(); ++c)
    for (std::size_t stage = 0; stage < kSignalStages.size(); ++stage) {
      const std::size_t s = c * kSignalStages.size() + stage;
      if (stage == 2 && !with_truth_) continue;
      const std::string name = fmt::format("{}.{}", kSignals[c].id, kSignalStages[stage]);
      std::vector<double>& low = series["signal." + name + ".min"];
      std::vector<double>& high = series["signal." + name + ".max"];
      for (std::size_t b = 0; b < envelope_.buckets(); ++b) {
        low.push_back(envelope_.low(b, s));
        high.push_back(envelope_.high(b, s));
      }
      series["detail." + name] = detail_[s];
    }
}

void GapHistogram::add(double gap, double hamiltonian_exact) {
  ++counts_[gap_bin(gap, hamiltonian_exact)];
  ++total_;
}

void GapHistogram::report(std::map<std::string, std::vector<double>>& series) const {
  if (total_ > 0) series["gap_counts"].assign(counts_.begin(), counts_.end());
}

}  // namespace odobench
