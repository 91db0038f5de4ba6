#include "bench/studies/entropy/linear_comparison.hpp"

#include <algorithm>
#include <limits>

namespace odobench {

double CpuMeter::now() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

CpuMeter::CpuMeter() {
  double lowest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 1000; ++i) {
    const double begin = now();
    lowest = std::min(lowest, now() - begin);
  }
  overhead_ = lowest;
}

LinearComparison::LinearComparison(const ProfileForm& profile)
    : smoother_(profile), filtered_(static_cast<std::size_t>(profile.constants().samples)) {}

void LinearComparison::push(const EntropySample& sample) {
  filter_.begin();
  smoother_.push(sample);
  filter_.end();
  filtered_.push(smoother_.filtered());
  back_.begin();
  smoothed_ = smoother_.smoothed();
  back_.end();
}

void LinearComparison::report(Measures& measures) const {
  const auto put = [&](const char* stage, double seconds) {
    measures.put({std::string("cpu.") + stage, 1e6 * seconds, "us", Better::None, "", true});
  };
  put("after", entropy_.mean());
  put("kalman", filter_.mean());
  put("smoother", filter_.mean() + back_.mean());
}

}  // namespace odobench
