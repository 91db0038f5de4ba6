#include "problems/entropy/sliding_filter.hpp"

#include <algorithm>

namespace odobench {

SlidingFilter::SlidingFilter(const ProfileForm& profile, BlockSearch* search)
    : profile_(profile), search_(search), history_(profile), predictor_(profile.constants()) {
  const auto size = static_cast<std::size_t>(increment_count(profile.constants().samples));
  g_.resize(size);
  x_.resize(size);
  output_.t.resize(size);
  for (const QuadraticBlock& block : profile.blocks())
    for (const Eigen::Index i : block.index) place_.push_back(static_cast<std::size_t>(i));
}

const FilterOutput* SlidingFilter::push(const EntropySample& sample) {
  history_.push(sample);
  if (!history_.full()) return nullptr;
  FilterOutput& out = output_;
  out.zero = profile_.linear_term(history_.window(), g_);
  if (search_ != nullptr) {
    out.search = search_->minimise(g_, x_);
    for (std::size_t i = 0; i < x_.size(); ++i) out.t[place_[i]] = x_[i];
    out.state = profile_.closed_form(out.zero, x_);
  } else {
    out.state = out.zero.state;
  }
  out.hamiltonian = out.zero.h0 - out.search.cost;
  out.first = predictor_.predict(out.state.sx1, out.state.sy1, out.state.r1);
  out.index = windows_++;
  return &out;
}

}  // namespace odobench
