// Errors that recordings share: by the rule of integration, and within kinds of drive.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <cmath>

#include "bench/catalogue/scenarios.hpp"
#include "problems/simulation/demo_generator.hpp"
#include "problems/simulation/simulated_set.hpp"
#include "problems/trust/trust.hpp"
#include "solvers/solve.hpp"

namespace odobench {
namespace {

// What Euler's rule does to a number is what fits by both rules say; drives that were made by it say nothing.
TEST(CommonErrors, SaysWhatTheRuleOfIntegrationMoves) {
  for (const bool off_nominal : {true, false}) {
    const Dataset set = off_nominal
                            ? simulate::simulate_set(load_recording_scenario("off_nominal"), 1001).dataset
                            : make_demo_dataset();
    Trust by_rule[2];
    for (const auto rule : {robots::IntegrationRule::Euler, robots::IntegrationRule::Arc}) {
      CalibrationOptions options;
      options.rule = rule;
      const Problem problem(CalibrationProblem(set.robot, set.recordings, options));
      const Vector z = solve(problem, {"lm", {}}, problem.start(), {}).x;
      by_rule[rule == robots::IntegrationRule::Arc] =
          assess_trust(RecordingCosts(set.robot, set.recordings, options), set.robot, z);
    }
    const std::vector<RuleShift>& moved = by_rule[0].moved_by_rule;
    EXPECT_EQ(moved.empty(), !off_nominal);
    EXPECT_TRUE(by_rule[1].moved_by_rule.empty());
    const std::string all = fmt::format("{}", fmt::join(by_rule[0].sentences, " "));
    EXPECT_EQ(all.find("--integration=arc") != std::string::npos, off_nominal);
    for (const RuleShift& m : moved)
      for (std::size_t k = 0; k < by_rule[0].determined.size(); ++k)
        if (by_rule[0].determined[k].number.name == m.name) {
          const double refitted =
              by_rule[1].determined[k].number.value - by_rule[0].determined[k].number.value;
          EXPECT_NEAR(m.shift, refitted, 0.05 * std::abs(refitted)) << m.name;
        }
  }
}

// Gains that differ from kind to kind and repeat within: a kind is an observation then.
TEST(CommonErrors, TakesKindsAsObservationsWhereTheirErrorsRepeat) {
  simulate::RecordingScenario scenario = load_recording_scenario("rich");
  Trust trust[2];
  for (const bool gains : {false, true}) {
    if (gains) {
      double sign = 1;
      for (const simulate::Drive& drive : scenario.drives) {
        scenario.slip.gains[drive.name] = {1 + 2e-3 * sign, 1 - 3e-3 * sign};
        sign = -0.7 * sign + 0.2;
      }
    }
    const Dataset set = simulate::simulate_set(scenario, 1001).dataset;
    const CalibrationOptions options;
    const Problem problem(CalibrationProblem(set.robot, set.recordings, options));
    const Vector z = solve(problem, {"lm", {}}, problem.start(), {}).x;
    trust[gains] = assess_trust(RecordingCosts(set.robot, set.recordings, options), set.robot, z);
  }
  EXPECT_FALSE(trust[0].between_kinds);
  EXPECT_TRUE(trust[1].between_kinds) << trust[1].kind_test.p;
  int wider = 0;
  for (std::size_t k = 0; k < trust[1].determined.size(); ++k) {
    const Interval& i = trust[1].determined[k].interval;
    EXPECT_LE(i.df, static_cast<double>(trust[1].kinds)) << trust[1].determined[k].number.name;
    wider += i.half_width > 2 * i.same_half_width ? 1 : 0;
  }
  EXPECT_GE(wider, 3) << "what repeats is in the one and not in the other";
}

}  // namespace
}  // namespace odobench
