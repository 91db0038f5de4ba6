// The relative-entropy filter over a whole run: a window of N samples slides by one sample, each window is
// solved from t = 0, and the estimate of its FIRST sample is what comes out: a smoother N - 1 samples late
// (thesis, section 3.3). Memory does not depend on the length of the run.
#pragma once

#include "problems/entropy/profile_form.hpp"

namespace odobench {

struct FilterOutput {
  std::int64_t index = 0;   // of the window and of its first sample, from 0
  double hamiltonian = 0;   // H at the solution
  EntropyState state;       // at the solution
  WindowZero zero;          // H and the state without increments
  EntropyPrediction first;  // estimate of the window's first sample
  std::vector<double> t;    // 3N-5, in the thesis' order
  SearchResult search;
};

class SlidingFilter {
 public:
  // `search` works on profile.blocks(); it and the profile outlive the filter. Without one t stays 0.
  SlidingFilter(const ProfileForm& profile, BlockSearch* search);

  // Takes one sample. The solution of the window that it completes, valid until the next call; null for the
  // first N-1.
  const FilterOutput* push(const EntropySample& sample);
  std::int64_t windows() const { return windows_; }

 private:
  const ProfileForm& profile_;
  BlockSearch* search_;
  SampleHistory history_;
  Predictor predictor_;
  std::int64_t windows_ = 0;
  std::vector<double> g_, x_;
  std::vector<std::size_t> place_;
  FilterOutput output_;
};

}  // namespace odobench
