// What the figures of `bench filter` show, gathered while windows go by in memory that does not depend on how
// many.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "bench/studies/entropy/entropy_setup.hpp"
#include "problems/entropy/sliding_filter.hpp"
#include "reports/kinds/entropy/entropy_tables.hpp"

namespace odobench {

// Signals of the same rows as bands: buckets of equal width that hold the minimum and the maximum of every
// signal, so that no extreme is lost. When there would be more than kMost buckets, neighbours are merged and
// the width doubles.
class SignalEnvelope {
 public:
  static constexpr std::size_t kMost = 480;

  explicit SignalEnvelope(std::size_t signals) : signals_(signals) {}
  void add(std::span<const double> values);  // one of each signal

  std::int64_t width() const { return width_; }  // rows per bucket
  std::size_t buckets() const { return low_.size() / signals_; }
  double low(std::size_t bucket, std::size_t signal) const { return low_[bucket * signals_ + signal]; }
  double high(std::size_t bucket, std::size_t signal) const { return high_[bucket * signals_ + signal]; }

 private:
  void halve();
  std::size_t signals_;
  std::int64_t width_ = 1, rows_ = 0;
  std::vector<double> low_, high_;
};

// Before, after and truth of encoders, accelerations and rotation: as bands over the whole run, and as they
// are over its first rows. The series are those of reports/kinds/entropy/entropy_tables.hpp.
class SignalMeter {
 public:
  explicit SignalMeter(bool with_truth);
  // The window's first row and the filter's output; `truth` of that row and the next, null without.
  void add(const ConvertedRow& row, const FilterOutput& output, const TrueSample* truth,
           const TrueSample* next);
  void report(std::map<std::string, std::vector<double>>& series) const;

 private:
  static constexpr std::size_t kDetail = 200;
  bool with_truth_;
  SignalEnvelope envelope_;
  std::vector<std::vector<double>> detail_;  // per signal
};

// Counts of H_exact - H in the bins of reports/kinds/entropy/entropy_tables.hpp.
class GapHistogram {
 public:
  void add(double gap, double hamiltonian_exact);
  void report(std::map<std::string, std::vector<double>>& series) const;

 private:
  std::array<double, kGapBins> counts_{};
  double total_ = 0;
};

}  // namespace odobench
