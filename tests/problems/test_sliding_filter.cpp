// The relative-entropy filter over whole runs.
#include <gtest/gtest.h>

#include "problems/entropy/direct_form.hpp"
#include "problems/entropy/sliding_filter.hpp"
#include "problems/entropy/window_problem.hpp"
#include "solvers/lattice/ternary_search.hpp"
#include "tests/support/data/entropy_windows.hpp"

namespace odobench {
namespace {

// Many more samples than the filter keeps, so that its history wraps.
TEST(SlidingFilter, EveryWindowIsTheWindowSolvedByItself) {
  EntropyWindow run = testing::random_window(400, 7);
  EntropyConstants constants = run.constants;
  for (const int samples : {3, 6, 10}) {
    constants.samples = samples;
    const ProfileForm profile(constants);
    const auto search = ternary_exact(profile.blocks());
    SlidingFilter filter(profile, search.get());
    int windows = 0;
    for (std::size_t n = 0; n < run.samples.size(); ++n) {
      const FilterOutput* out = filter.push(run.samples[n]);
      ASSERT_EQ(out != nullptr, n + 1 >= static_cast<std::size_t>(samples));
      if (out == nullptr) continue;
      EXPECT_EQ(out->index, windows++);
      EntropyWindow window{"", "", constants, {}};
      const auto first = run.samples.begin() + static_cast<std::ptrdiff_t>(n + 1) - samples;
      window.samples.assign(first, first + samples);
      const Vector t = Eigen::Map<const Vector>(out->t.data(), increment_count(samples));
      const WindowProblem problem(window);
      EXPECT_NEAR(out->hamiltonian, -problem.cost(t), 1e-11 * std::abs(out->hamiltonian));
      const EntropyState state = problem.state(t);
      EXPECT_NEAR(out->state.r1, state.r1, 1e-13);
      EXPECT_NEAR(out->state.sx1, state.sx1, 1e-13);
      EXPECT_NEAR(out->state.sy1, state.sy1, 1e-13);
      EXPECT_NEAR(out->state.ax12, state.ax12, 1e-11);
      EXPECT_NEAR(out->state.ay12, state.ay12, 1e-11);
      EXPECT_NEAR(out->first.x[1], Predictor(constants).predict(state.sx1, state.sy1, state.r1).x[1], 1e-13);
    }
    EXPECT_EQ(filter.windows(), 400 - samples + 1);
  }
}

TEST(SlidingFilter, WithoutASearchNothingIsIncremented) {
  const EntropyWindow run = testing::random_window(30, 3);
  EntropyConstants constants = run.constants;
  constants.samples = 10;
  const ProfileForm profile(constants);
  SlidingFilter filter(profile, nullptr);
  for (const EntropySample& sample : run.samples) {
    const FilterOutput* out = filter.push(sample);
    if (out == nullptr) continue;
    EXPECT_EQ(out->hamiltonian, out->zero.h0);
    EXPECT_EQ(out->state.sx1, out->zero.state.sx1);
    for (const double t : out->t) EXPECT_EQ(t, 0);
  }
}

}  // namespace
}  // namespace odobench
