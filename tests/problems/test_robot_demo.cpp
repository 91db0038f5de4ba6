// Made-up sets of every class of robots: the same bits for the same seed, and calibration finds the truth.
#include <gtest/gtest.h>

#include <cmath>

#include "datasets/robots/layouts.hpp"
#include "problems/calibration/calibration_problem.hpp"
#include "problems/simulation/robot_demo.hpp"
#include "solvers/solve.hpp"
#include "tests/support/run_process.hpp"

namespace odobench {
namespace {

Vector nominal_of(const Robot& robot) {
  Vector z(static_cast<Eigen::Index>(robot.parameters.size()));
  for (Eigen::Index i = 0; i < z.size(); ++i) z[i] = robot.parameters[static_cast<std::size_t>(i)].nominal;
  return z;
}

class RobotDemo : public ::testing::TestWithParam<std::string> {};

// Classes whose parameters are few and each of them known: within 0.1 mm and 0.1 mrad, bicycles within 1 mm.
double tolerance(const std::string& kinematics) {
  if (kinematics == "bicycle") return 1e-3;
  const bool all = kinematics == "differential" || kinematics == "tricycle" || kinematics == "omni3" ||
                   kinematics == "omni4" || kinematics == "skid_steer";
  return all ? 1e-4 : 0;
}

TEST_P(RobotDemo, CalibratesBackToTheTruth) {
  const Dataset d = make_robot_demo(GetParam(), 7);
  CalibrationOptions options;
  options.rule = d.robot.rule;
  const auto problem = std::make_shared<const CalibrationProblem>(d.robot, d.recordings, options);
  const std::vector<double>& values = d.known_parameters.at(0).values;
  const Vector truth = Eigen::Map<const Vector>(values.data(), static_cast<Eigen::Index>(values.size()));
  const Result result = solve(Problem(problem), parse_solver_list("lm").front(), nominal_of(d.robot), {});
  EXPECT_EQ(result.termination, Termination::Converged) << result.message;
  // The optimum explains the noise at least as well as the truth, and leaves nothing but noise: 0.2 mm,
  // 0.5 mrad, what counters round off, and what the noise of the first pose turns and shifts.
  EXPECT_LE(result.cost, problem->cost(truth));
  EXPECT_LT(std::sqrt(result.cost / static_cast<double>(problem->residual_count())), 2e-3);
  EXPECT_GT(problem->cost(nominal_of(d.robot)), 100 * result.cost);
  // Odometry by what was found is odometry by the truth.
  for (std::size_t i = 0; i < d.recordings.size(); ++i) {
    const PoseTrack a = problem->integrate(i, truth), b = problem->integrate(i, result.x);
    EXPECT_NEAR(a.x.back(), b.x.back(), 5e-3) << d.recordings[i].id;
    EXPECT_NEAR(a.y.back(), b.y.back(), 5e-3) << d.recordings[i].id;
    EXPECT_NEAR(a.theta.back(), b.theta.back(), 3e-3) << d.recordings[i].id;
  }
  const double within = tolerance(GetParam());
  for (Eigen::Index p = 0; within > 0 && p < truth.size(); ++p)
    EXPECT_NEAR(result.x[p], truth[p], within) << d.robot.parameters[static_cast<std::size_t>(p)].name;
}

TEST_P(RobotDemo, TheSetComesBackFromItsFiles) {
  const testing::TemporaryFolder folder;
  Dataset d = make_robot_demo(GetParam(), 3);
  d.recordings.resize(2);
  for (const bool inline_recordings : {false, true}) {
    save_dataset(d, folder / "set.json", inline_recordings, Existing::Replace);
    const Dataset read = load_dataset(folder / "set.json");
    ASSERT_EQ(read.recordings.size(), d.recordings.size());
    for (std::size_t i = 0; i < d.recordings.size(); ++i) {
      EXPECT_EQ(read.recordings[i].signals, d.recordings[i].signals);
      EXPECT_EQ(read.recordings[i].reference, d.recordings[i].reference);
      EXPECT_EQ(read.recordings[i].time_us, d.recordings[i].time_us);
    }
    CalibrationOptions options;
    options.rule = read.robot.rule;
    EXPECT_EQ(read.robot.rule, d.robot.rule);
    const CalibrationProblem before(d.robot, d.recordings, options),
        after(read.robot, read.recordings, options);
    const Vector z = nominal_of(d.robot) * 1.001;
    EXPECT_EQ(before.cost(z), after.cost(z));
    EXPECT_EQ(make_robot_demo(GetParam(), 3).recordings[1].reference, d.recordings[1].reference);
    EXPECT_NE(make_robot_demo(GetParam(), 4).recordings[1].reference, d.recordings[1].reference);
  }
}

std::vector<std::string> classes() {
  std::vector<std::string> names;
  for (const robots::Layout& layout : robots::layouts()) names.push_back(layout.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Every, RobotDemo, ::testing::ValuesIn(classes()),
                         [](const auto& c) { return "of_" + c.param; });

}  // namespace
}  // namespace odobench
