// Drives that differ from their siblings are set aside, named, and missed by nobody.
#include "problems/trust/sibling_screening.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "problems/simulation/demo_generator.hpp"
#include "problems/simulation/robot_demo.hpp"
#include "solvers/solve.hpp"
#include "tests/support/data/corrupted_drives.hpp"
#include "tests/support/data/vitko_problem.hpp"

namespace odobench {
namespace {

using testing::vitko_dataset;

Screening screened(const Robot& robot, const std::vector<Recording>& recordings, double limit = 8) {
  CalibrationOptions options;
  options.rule = robot.rule;
  options.from_origin = robot.kinematics == "4wis4wid";
  return screen_siblings(robot, recordings, options, limit);
}

std::vector<std::string> names_of(const Screening& found, const std::vector<Recording>& recordings) {
  std::vector<std::string> names;
  for (const std::size_t n : found.set_aside()) names.push_back(recordings[n].id);
  return names;
}

TEST(Screening, ScoresOfThePublishedRecordingsAsInTheReference) {
  ODOBENCH_NEEDS_SHARED();
  const nlohmann::json all =
      nlohmann::json::parse(std::ifstream(testing::shared_folder() / "reference" / "trust_vitko2024.json"));
  const auto& expected = all["robust"]["sibling_screening"]["clean_z"];
  const Screening found = screened(vitko_dataset().robot, vitko_dataset().recordings);
  ASSERT_EQ(found.scores.size(), 30U);
  for (std::size_t n = 0; n < 30; ++n) {
    EXPECT_TRUE(found.scores[n].compared);
    EXPECT_NEAR(found.scores[n].z, expected[n].get<double>(), 1e-3) << vitko_dataset().recordings[n].id;
  }
  EXPECT_TRUE(found.set_aside().empty());
  EXPECT_EQ(
      names_of(screened(vitko_dataset().robot, vitko_dataset().recordings, 5), vitko_dataset().recordings),
      std::vector<std::string>{"line_y_4"});
}

TEST(Screening, NamesWhatBendsTheFit) {
  ODOBENCH_NEEDS_SHARED();
  std::vector<Recording> recordings = vitko_dataset().recordings;
  testing::corrupt(recordings, "all");
  EXPECT_EQ(names_of(screened(vitko_dataset().robot, recordings), recordings),
            (std::vector<std::string>{"line_x_2", "circle_ccw_3"}));
}

// One set of each kind of damage; tests/power/robust_power.cpp makes a hundred.
TEST(Screening, KeepsTheTotalOfDamagedSets) {
  ODOBENCH_NEEDS_SHARED();
  const Dataset& set = vitko_dataset();
  CalibrationOptions options;
  options.from_origin = true;
  const auto total = [&](const std::vector<Recording>& recordings) {
    const auto model = std::make_shared<const CalibrationProblem>(set.robot, recordings, options);
    const Problem problem(model);
    double sum = 0;
    for (const MaxErrors& e :
         testing::vitko_model()->max_errors(solve(problem, {"lm", {}}, problem.start(), {}).x))
      sum += (e.x + e.y + e.theta) / 5;
    return sum;
  };
  const double usual = total(set.recordings);
  EXPECT_NEAR(usual, 0.378039, 1e-5);
  int left_out = 0;
  double worst_alone = 0;
  for (const char* kind : {"slip", "swap", "outlier", "pose", "mix", "fixed"}) {
    std::vector<Recording> recordings = set.recordings;
    std::vector<testing::Damage> done{{1, "slip", ""}, {12, "swap", ""}};  // line_x_2, circle_ccw_3
    if (std::string(kind) == "fixed")
      testing::corrupt(recordings, "swap+slip");
    else
      done = testing::damage_two(recordings, kind, 7000);
    const Screening found = screened(set.robot, recordings);
    worst_alone = std::max(worst_alone, total(recordings) / usual);
    std::vector<Recording> kept;
    for (std::size_t n = 0; n < recordings.size(); ++n) {
      const bool bad = n == done[0].recording || n == done[1].recording;
      EXPECT_TRUE(bad || !found.scores[n].set_aside) << kind << " " << recordings[n].id;
      left_out += found.scores[n].set_aside;
      if (!found.scores[n].set_aside) kept.push_back(recordings[n]);
    }
    EXPECT_LT(total(kept), 1.03 * usual) << kind;
  }
  EXPECT_GE(left_out, 4);
  EXPECT_GT(worst_alone, 1.03);  // without screening
}

TEST(Screening, LeavesCleanSetsAlone) {
  const Dataset demo = make_demo_dataset();
  EXPECT_TRUE(screened(demo.robot, demo.recordings).set_aside().empty());
  for (const char* robot : {"differential", "tricycle", "mecanum", "ackermann"})
    for (const std::uint64_t seed : {1, 2, 3}) {
      const Dataset set = make_robot_demo(robot, seed);
      const Screening found = screened(set.robot, set.recordings);
      EXPECT_TRUE(found.set_aside().empty()) << robot << seed << names_of(found, set.recordings).front();
    }
}

// Three repetitions of one drive and more, made of one: noise on the reference, a factor on the speeds.
std::vector<Recording> repeated(const Dataset& set, int repetitions, std::initializer_list<int> bad) {
  std::vector<Recording> drives;
  for (int i = 0; i < repetitions; ++i) {
    Recording r = set.recordings.front();
    r.id = "drive_" + std::to_string(i + 1);
    r.trajectory = "drive";
    r.repetition = i + 1;
    std::vector<double>& first = r.signals.front().values;
    for (std::size_t k = 0; k < r.reference.x.size(); ++k)
      r.reference.x[k] += 1e-3 * std::sin(0.01 * static_cast<double>(k) + i);
    if (std::find(bad.begin(), bad.end(), i) != bad.end())
      for (std::size_t k = first.size() / 3; k < first.size() / 2; ++k) first[k] *= 2.5 + 0.3 * i;
    drives.push_back(std::move(r));
  }
  return drives;
}

TEST(Screening, ServesEveryClassAndNeverTakesHalfOfAKind) {
  for (const char* robot : {"differential", "mecanum"}) {
    const Dataset set = make_robot_demo(robot, 1);
    const std::vector<Recording> one = repeated(set, 5, {2});
    const Screening found = screened(set.robot, one);
    EXPECT_EQ(names_of(found, one), std::vector<std::string>{"drive_3"}) << robot;
    EXPECT_GT(found.scores[2].z, 8);
    EXPECT_TRUE(screened(set.robot, repeated(set, 5, {})).set_aside().empty());
    const std::vector<Recording> two = repeated(set, 5, {1, 2});
    EXPECT_EQ(names_of(screened(set.robot, two), two), (std::vector<std::string>{"drive_2", "drive_3"}));
    // Of four, two are half.
    EXPECT_TRUE(screened(set.robot, repeated(set, 4, {1, 2})).set_aside().empty()) << robot;
    const Screening few = screened(set.robot, repeated(set, 2, {1}));
    EXPECT_FALSE(few.any_compared());
    EXPECT_TRUE(few.set_aside().empty());
  }
}

// Drives of one name that are no repetitions of each other are not compared.
TEST(Screening, ComparesOnlyWhatIsAlike) {
  const Dataset set = make_robot_demo("differential", 1);
  std::vector<Recording> drives = repeated(set, 4, {});
  for (std::int64_t& t : drives[3].time_us) t *= 3;  // three times as long
  const Screening found = screened(set.robot, drives);
  EXPECT_TRUE(found.scores[0].compared);
  EXPECT_FALSE(found.scores[3].compared);
  EXPECT_TRUE(found.set_aside().empty());
}

}  // namespace
}  // namespace odobench
