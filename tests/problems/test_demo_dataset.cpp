// The synthetic set that is part of the repository: reproducible, honest about its truth, and good enough to
// find it.
#include "datasets/robot_4wis4wid.hpp"
#include "problems/simulation/demo_generator.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>

#include "base/files.hpp"
#include "datasets/native/columns.hpp"
#include "problems/calibration/calibration_problem.hpp"
#include "tests/support/data/vitko_problem.hpp"
#include "tests/support/run_process.hpp"
#include "tests/support/source_dir.hpp"

namespace odobench {
namespace {

namespace fs = std::filesystem;

const fs::path kCommitted = source_dir() / "datasets" / "demo";

const Dataset& demo() {
  static const Dataset set = load_dataset(kCommitted / "set.json");
  return set;
}
Vector truth() {
  return Eigen::Map<const Vector>(demo().known_parameters.at(0).values.data(), kCalibrationParameters);
}
Vector nominal() {
  Vector z(kCalibrationParameters);
  for (Eigen::Index i = 0; i < z.size(); ++i)
    z[i] = demo().robot.parameters[static_cast<std::size_t>(i)].nominal;
  return z;
}

TEST(DemoDataset, TheCommittedBytesAreTheGenerators) {
  const testing::TemporaryFolder folder;
  save_dataset(make_demo_dataset(), folder / "set.json");
  std::size_t files = 0;
  std::uintmax_t bytes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(kCommitted)) {
    if (!entry.is_regular_file()) continue;
    const fs::path name = fs::relative(entry.path(), kCommitted);
    EXPECT_TRUE(read_file(entry.path()) == read_file(folder / name.string())) << name;
    ++files;
    bytes += entry.file_size();
  }
  EXPECT_EQ(files, 31u);
  EXPECT_LE(bytes, 1'900'000u);
}

TEST(DemoDataset, SeedsMakeOtherDrivesOfTheSameRobot) {
  const Dataset a = make_demo_dataset(1), b = make_demo_dataset(2);
  for (std::size_t i = 0; i < a.recordings.size(); ++i) {
    EXPECT_NE(a.recordings[i].reference.x, b.recordings[i].reference.x) << i;
    EXPECT_NE(steering_of(a.recordings[i], 0), steering_of(b.recordings[i], 0)) << i;
  }
  EXPECT_NE(steering_of(a.recordings[0], 0), steering_of(a.recordings[1], 0)) << "repetitions differ";
  EXPECT_EQ(a.known_parameters[0].values, b.known_parameters[0].values);
}

TEST(DemoDataset, HasSixTrajectoriesOfFiveDrives) {
  ASSERT_EQ(demo().recordings.size(), 30u);
  // Where each drive ends, up to the drift of a robot that believes in its nominal parameters.
  const double turn = 2 * std::numbers::pi;
  const double ends[6][3] = {{4, 0, 0}, {0, 4, 0}, {0, 0, turn}, {0, 0, -turn}, {0, 0, turn}, {0, 0, -turn}};
  for (std::size_t i = 0; i < 30; ++i) {
    const Recording& r = demo().recordings[i];
    EXPECT_EQ(r.trajectory, demo().trajectories[i / 5].name);
    EXPECT_NEAR(r.reference.x.back(), ends[i / 5][0], 0.6) << r.id;
    EXPECT_NEAR(r.reference.y.back(), ends[i / 5][1], 0.6) << r.id;
    EXPECT_NEAR(r.reference.theta.back(), ends[i / 5][2], 0.4) << r.id;
    EXPECT_NEAR(static_cast<double>(r.time_us.back()) * 1e-6, i < 20 ? 82.4 : 42.4, 0.2) << r.id;
  }
}

TEST(DemoDataset, SignalsLieOnTheEncodersGrid) {
  const double steering = 2 * std::numbers::pi / 4096, speed = 0.229 * 2 * std::numbers::pi / 60;
  const auto off_grid = [](double value, double quantum) {
    return std::abs(value / quantum - std::round(value / quantum));
  };
  for (const Recording& r : demo().recordings) {
    std::int64_t shortest = 1'000'000, longest = 0;
    for (std::size_t k = 0; k < r.size(); ++k) {
      for (std::size_t i = 0; i < kWheelCount; ++i) {
        ASSERT_LT(off_grid(steering_of(r, i)[k], steering), 1e-9);
        ASSERT_LT(off_grid(wheel_speed_of(r, i)[k], speed), 1e-9);
      }
      ASSERT_EQ(r.reference.x[k], std::round(r.reference.x[k] * 1e7) / 1e7);
      if (k == 0) continue;
      shortest = std::min(shortest, r.time_us[k] - r.time_us[k - 1]);
      longest = std::max(longest, r.time_us[k] - r.time_us[k - 1]);
    }
    EXPECT_LT(shortest, 120'000) << r.id;
    EXPECT_GT(shortest, 20'000) << r.id;
    EXPECT_GT(longest, 135'000) << r.id;
  }
}

TEST(DemoDataset, TheTruthLiesInsideTheBoxAwayFromNominal) {
  double nearest = 1;  // distance to a bound relative to the box's half width
  for (std::size_t i = 0; i < 12; ++i) {
    const RobotParameter& p = demo().robot.parameters[i];
    const double value = truth()[static_cast<Eigen::Index>(i)];
    EXPECT_GE(std::abs(value / p.nominal - 1), 0.01) << p.name;
    EXPECT_LE(std::abs(value / p.nominal - 1), 0.045) << p.name;
    nearest = std::min(
        {nearest, (value - p.lower) / (p.upper - p.lower) * 2, (p.upper - value) / (p.upper - p.lower) * 2});
  }
  EXPECT_GT(nearest, 0.05);
  EXPECT_LT(nearest, 0.2);
}

// At the truth what remains is the capture's noise: 0.15 mm and 0.05 mrad a sample, and what the noise of the
// first heading does to a 4 m line (it is the start of the estimate).
TEST(DemoDataset, TheTruthExplainsTheDrives) {
  double samples = 0;
  for (const Recording& r : demo().recordings) samples += static_cast<double>(r.size() - 1);
  const double noise = samples * (2 * 1.5e-4 * 1.5e-4 + 5e-5 * 5e-5);
  const double cost = direct::cost(demo().recordings, truth());
  EXPECT_GT(cost, 0.9 * noise);
  EXPECT_LT(cost, 1.6 * noise);
  EXPECT_GT(direct::cost(demo().recordings, nominal()), 1e4 * cost);
}

// Standard deviation of each parameter by the Cramer-Rao bound, relative to its value: a solver that finds
// the minimum finds the truth.
TEST(DemoDataset, EveryParameterIsDetermined) {
  const CalibrationProblem problem(testing::parameters_of(demo()), demo().recordings);
  NormalEquations e;
  problem.normal_equations(truth(), e);
  const double variance = e.cost / static_cast<double>(problem.residual_count() - kCalibrationParameters);
  const Matrix covariance =
      variance * e.jtj.ldlt().solve(Matrix::Identity(kCalibrationParameters, kCalibrationParameters));
  for (Eigen::Index i = 0; i < kCalibrationParameters; ++i) {
    EXPECT_LT(std::sqrt(covariance(i, i)) / std::abs(truth()[i]), 5e-4) << i;
    EXPECT_GT(std::sqrt(covariance(i, i)) / std::abs(truth()[i]), 1e-6) << i;
  }
}

}  // namespace
}  // namespace odobench
