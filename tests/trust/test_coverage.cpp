// Twenty simulated sets of known truth: 95 % intervals hold it. The study of 200 sets of five kinds is
// trust_coverage; docs/uncertainty.md has its table.
#include <gtest/gtest.h>

#include "bench/catalogue/scenarios.hpp"
#include "problems/simulation/robot_demo.hpp"
#include "problems/simulation/simulated_set.hpp"
#include "tests/support/data/coverage.hpp"

namespace odobench {
namespace {

using testing::Held;
using testing::SetCoverage;

TEST(Coverage, OfTwentyRichSets) {
  simulate::RecordingScenario scenario = load_recording_scenario("rich");
  simulate::RecordingScenario once = scenario;
  once.repetitions = 1;
  Held determined, parameters, end_errors;
  for (std::uint64_t seed = 501; seed <= 520; ++seed) {
    const SetCoverage one = testing::coverage_of(simulate::simulate_set(scenario, seed).dataset,
                                                 simulate::simulate_set(once, seed + 1'000'000).dataset);
    for (const auto& [name, held] : one.determined) determined += held;
    parameters += one.parameters;
    end_errors += one.end_errors;
  }
  EXPECT_EQ(determined.given, 120);
  EXPECT_EQ(parameters.given + parameters.refused, 240);
  EXPECT_EQ(end_errors.given, 20 * 18 * 3);
  // Binomial bands of 99.9 %, wider since the numbers of one set come from the same drives.
  EXPECT_GE(determined.share(), 86);
  EXPECT_GE(parameters.share(), 88);
  EXPECT_GE(end_errors.share(), 90);
  EXPECT_LE(end_errors.share(), 99);
}

}  // namespace
}  // namespace odobench
