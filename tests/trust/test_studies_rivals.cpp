// Drives that decide between two models: the criterion on numbers that are known, and that the planned drives
// do decide where the true model is known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "base/parallel.hpp"
#include "bench/studies/planning/rival_models.hpp"
#include "bench/studies/planning/settling_plan.hpp"
#include "bench/studies/trust/models_study.hpp"
#include "tests/support/data/rival_truth.hpp"
#include "tests/support/data/vitko_problem.hpp"

namespace odobench {
namespace {

using testing::PathNoise;
using testing::rival_truth;
using testing::RivalTruth;
using testing::true_recordings;
using testing::vitko_dataset;

TEST(Discrimination, IsTheDistanceInWhatIsLeftOpen) {
  EndPrediction a{{0.03, 0, 0.1}, Eigen::Matrix3d::Zero()}, b{{0, 0, 0}, Eigen::Matrix3d::Zero()};
  const Eigen::Matrix3d scatter = Eigen::Vector3d(1e-4, 1e-4, 1e-2).asDiagonal();
  const Discrimination d = discriminate(a, b, scatter);
  EXPECT_NEAR(d.separation(1), std::sqrt(9 + 1), 1e-12);
  EXPECT_NEAR(d.separation(4), 2 * std::sqrt(10), 1e-12);
  EXPECT_NEAR(probability_right(2 * 1.6448536269514722), 0.95, 1e-12);
  EXPECT_EQ(d.repetitions(), 2);  // 3.29 standard deviations: 1.08 drives
  // What one of the two may still do counts for the whole: no repetition averages it out.
  b.open = Eigen::Vector3d(1, 1, 1).asDiagonal();
  EXPECT_LT(discriminate(a, b, scatter).separation(1e9), 0.11);
  EXPECT_EQ(discriminate(a, b, scatter).repetitions(), std::nullopt);
}

// Noise whose neighbours correlate with rho is worth n (1 - rho) / (1 + rho) independent numbers. Sums up to
// the first zero are too long on average, so that the count errs on the safe side.
TEST(Discrimination, CountsResidualsByTheirCorrelation) {
  const RivalTruth truth =
      rival_truth("4wis4wid", {"least_squares", "contact_offset", "no_steering_rate"}, 0.006);
  std::vector<Recording> recordings = true_recordings(truth, {"line"}, 40, {0, 0, 0, 0}, 1);
  Random random(7);
  constexpr double kRho = 0.8;
  double samples = 0;
  for (Recording& r : recordings) {
    std::array<double, 3> e{};
    for (std::size_t k = 0; k < r.size(); ++k) {
      for (double& one : e) one = kRho * one + random.normal(1e-3);
      r.reference.x[k] += e[0];
      r.reference.y[k] += e[1];
      r.reference.theta[k] += e[2];
    }
    r.reference.theta[0] = 0;
    samples += 3 * static_cast<double>(r.size() - 1);
  }
  const CalibrationProblem problem(truth.robot, recordings, truth.options);
  EXPECT_NEAR(effective_residuals(problem, truth.z) / (samples * (1 - kRho) / (1 + kRho)), 0.75, 0.2);
}

// The published recordings: degrees of an independent evaluation without common code.
TEST(RivalModels, SmallCirclesTellContactsFromSlipOnTheRealRobot) {
  if (vitko_dataset().recordings.empty()) GTEST_SKIP() << "no published recordings";
  const Robot& robot = vitko_dataset().robot;
  CalibrationOptions options;
  options.from_origin = true;
  const CalibrationProblem plain(robot, vitko_dataset().recordings, options);
  ModelFits a, b;
  a.terms = model_of_text("least_squares+contact_offset");
  b.terms = model_of_text("speed_factor:rotation");
  fit_model(plain, robot, {}, {}, Stop(), a);
  fit_model(plain, robot, {}, {}, Stop(), b);
  const RivalPlan plan = plan_rivals(plain, robot, a, b, 2, Stop());
  ASSERT_EQ(plan.refused, "");
  const auto find = [&](const std::string& name) -> const RivalDrive& {
    for (const RivalDrive& d : plan.drives)
      if (d.name == name) return d;
    throw std::out_of_range(name);
  };
  const auto degrees = [&](const char* name) {
    return std::abs(find(name).discrimination.difference[2]) * 180 / 3.14159265358979323846;
  };
  EXPECT_NEAR(degrees("circle_0.2m_ccw"), 4.0, 0.15);
  EXPECT_NEAR(degrees("circle_0.2m_cw"), 4.4, 0.15);
  EXPECT_NEAR(degrees("circle_0.5m_ccw"), 0.1, 0.1);
  EXPECT_NEAR(degrees("circle_1m_ccw"), 0.8, 0.15);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_THAT(plan.drives[i].name, ::testing::StartsWith("circle_0."));
    EXPECT_EQ(plan.drives[i].repetitions, 1);
  }
  EXPECT_EQ(find("circle_0.2m_ccw").repetitions, 1);
  EXPECT_EQ(find("circle_0.5m_ccw").repetitions, std::nullopt);
  for (const char* recorded : {"line_x", "line_y", "circle_ccw", "circle_cw", "rotation_ccw", "rotation_cw"})
    EXPECT_EQ(find(recorded).repetitions, std::nullopt) << recorded;
  EXPECT_THAT(plan.unknown, ::testing::UnorderedElementsAre("square_cw", "square_ccw"));
}

struct Outcome {
  bool planned = false, right = false;
  int repetitions = 0;
};

// A set by the true model, the plan from it, the planned drives by the true model, both fitted to all.
Outcome decide(const std::vector<std::string>& right, const std::vector<std::string>& wrong, double extra,
               std::uint64_t seed) {
  const RivalTruth truth = rival_truth("4wis4wid", right, extra);
  PathNoise noise;
  std::vector<Recording> recordings = true_recordings(
      truth, {"circle_cw", "circle_ccw", "turn_cw", "turn_ccw", "line", "sideways"}, 3, noise, seed);
  CalibrationOptions options = truth.options;
  options.model = {};
  const auto both = [&](std::array<ModelFits, 2>& fits, const CalibrationProblem& plain) {
    fits[0].terms = model_terms(right);
    fits[1].terms = model_terms(wrong);
    for (ModelFits& one : fits) fit_model(plain, truth.robot, {}, {}, Stop(), one);
  };
  std::array<ModelFits, 2> before, after;
  const CalibrationProblem plain(truth.robot, recordings, options);
  both(before, plain);
  const RivalPlan plan = plan_rivals(plain, truth.robot, before[0], before[1], 1, Stop());
  Outcome outcome;
  if (plan.drives.empty() || !plan.drives.front().repetitions) return outcome;
  outcome.planned = true;
  outcome.repetitions = *plan.drives.front().repetitions;
  for (Recording& r :
       true_recordings(truth, {plan.drives.front().name}, outcome.repetitions, noise, seed + 1000))
    recordings.push_back(std::move(r));
  for (std::size_t i = 0; i < recordings.size(); ++i) recordings[i].id += "#" + std::to_string(i);
  both(after, CalibrationProblem(truth.robot, recordings, options));
  outcome.right = after[0].cost < after[1].cost;
  return outcome;
}

// ODOBENCH_SEEDS=100 for the hundred sets of docs/planning.md.
TEST(RivalModels, ThePlannedDrivesDecide) {
  const char* asked = std::getenv("ODOBENCH_SEEDS");
  const int seeds = asked == nullptr ? 4 : std::atoi(asked);
  const std::vector<std::string> offset = {"least_squares", "contact_offset", "no_steering_rate"},
                                 factor = {"least_squares", "speed_factor:turn"};
  for (const bool contacts : {true, false}) {
    std::vector<Outcome> outcomes(static_cast<std::size_t>(seeds));
    parallel_for(outcomes.size(), 2, [&](std::size_t i) {
      outcomes[i] = contacts ? decide(offset, factor, 0.004, i + 1) : decide(factor, offset, 1.012, i + 1);
    });
    int planned = 0, right = 0, repetitions = 0;
    for (const Outcome& o : outcomes) {
      planned += o.planned;
      right += o.planned && o.right;
      repetitions += o.repetitions;
    }
    std::cout << (contacts ? "contact offset" : "speed factor") << " true: planned in " << planned << " of "
              << seeds << " sets, " << static_cast<double>(repetitions) / std::max(1, planned)
              << " repetitions, right in " << right << "\n";
    EXPECT_GE(planned, seeds * 9 / 10);
    EXPECT_GE(right, asked == nullptr ? planned - 1 : planned * 95 / 100);
  }
}

// A differential drive on straight lines alone: its wheels' distance is anybody's guess, and a turn tells it.
TEST(SettlingPlan, ATurnSettlesTheTrackOfARobotThatWentStraight) {
  RivalTruth truth = rival_truth("differential", {"lever_arm"}, 0.0);
  truth.z[truth.z.size() - 2] = 0;
  CalibrationOptions options = truth.options;
  options.model = {};
  int inside = 0;
  constexpr int kSets = 20;
  for (std::uint64_t seed = 1; seed <= kSets; ++seed) {
    const CalibrationProblem plain(truth.robot,
                                   true_recordings(truth, {"line", "line_back"}, 4, {}, 2 * seed), options);
    ModelFits own;
    fit_model(plain, truth.robot, {}, {}, Stop(), own);
    const SettlingPlan plan = plan_settling(plain, truth.robot, own, 1, Stop());
    ASSERT_EQ(plan.refused, "");
    ASSERT_THAT(plan.open, ::testing::ElementsAre("b"));
    ASSERT_THAT(plan.settled, ::testing::ElementsAre("b"));
    ASSERT_EQ(plan.drives.size(), 1u);
    EXPECT_GT(plan.largest_before, 0.9);
    EXPECT_LT(plan.largest_after, 0.5);
    // The promise: with these drives the track is found as well as planned.
    std::vector<Recording> all = plain.recordings();
    for (const SettlingDrive& d : plan.drives)
      for (Recording& r : true_recordings(truth, {d.name}, d.repetitions, {}, 2 * seed + 1))
        all.push_back(std::move(r));
    ModelFits after;
    fit_model(CalibrationProblem(truth.robot, all, options), truth.robot, {}, {}, Stop(), after);
    for (std::size_t i = 0; i < after.parameters.size(); ++i) {
      if (after.parameters[i].name != "b") continue;
      const double half = (after.parameters[i].upper - after.parameters[i].lower) / 2;
      const auto at = static_cast<Eigen::Index>(i);
      inside += std::abs(after.z[at] - truth.z[at]) < plan.largest_after * half;
    }
  }
  std::cout << "inside the planned 95 %: " << inside << " of " << kSets << "\n";
  EXPECT_GE(inside, kSets * 8 / 10);
}

}  // namespace
}  // namespace odobench
