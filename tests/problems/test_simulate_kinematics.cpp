// Inverse and forward kinematics, reference drives and noise-free recordings against independent values.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/angle.hpp"
#include "datasets/robot_4wis4wid.hpp"
#include "problems/calibration/calibration_problem.hpp"
#include "problems/simulation/simulated_set.hpp"
#include "tests/support/data/report_records.hpp"
#include "tests/support/data/vitko_problem.hpp"

namespace odobench::simulate {
namespace {

Parameters parameters(const nlohmann::json& list) {
  Parameters z{};
  for (std::size_t i = 0; i < z.size(); ++i) z[i] = list.at(i).get<double>();
  return z;
}
Twist twist(const nlohmann::json& list) {
  return {list.at(0).get<double>(), list.at(1).get<double>(), list.at(2).get<double>()};
}
void expect_twist(const Twist& found, const nlohmann::json& expected, const std::string& what) {
  EXPECT_NEAR(found.vx, expected.at(0).get<double>(), 1e-12) << what;
  EXPECT_NEAR(found.vy, expected.at(1).get<double>(), 1e-12) << what;
  EXPECT_NEAR(found.omega, expected.at(2).get<double>(), 1e-12) << what;
}
Parameters nominal() {
  return nominal_parameters(robot_4wis4wid());
}

RecordingScenario exact_scenario(const Parameters& truth, Kinematics kinematics) {
  RecordingScenario s = default_scenario();
  s.name = "exact";
  s.exact = true;
  s.control.closed_loop = false;
  s.repetitions = 1;
  s.truth.parameters = truth;
  s.truth.kinematics = kinematics;
  return s;
}

TEST(SimulateKinematics, MatchesTheReferenceTo1e12) {
  ODOBENCH_NEEDS_SHARED();
  const nlohmann::json reference = testing::reference_json("simulator.json");
  std::size_t cases = 0;
  for (const auto& entry : reference.at("inverse_kinematics")) {
    const std::string name = entry.at("name");
    const Parameters z = parameters(entry.at("p"));
    const WheelState w = inverse_kinematics(z, twist(entry.at("twist")));
    for (std::size_t i = 0; i < kWheelCount; ++i) {
      EXPECT_NEAR(w.steering[i], entry.at("delta")[i].get<double>(), 1e-12) << name << i;
      EXPECT_NEAR(w.speed[i], entry.at("omega")[i].get<double>(), 1e-12) << name << i;
    }
    expect_twist(forward_published(z, w), entry.at("forward_thesis"), name);
    expect_twist(forward_least_squares(z, w), entry.at("forward_lsq"), name);
    ++cases;
  }
  EXPECT_EQ(cases, 12u);
}

// Steering folded into (-pi/2, pi/2], wheels backwards for it, and least squares undo the inverse for any
// robot.
TEST(SimulateKinematics, RoundTripsForAnyTwist) {
  Parameters z = nominal();
  for (std::size_t i = 0; i < z.size(); ++i) z[i] *= 1 + 0.01 * std::sin(3.0 * static_cast<double>(i) + 1);
  for (int k = 0; k < 200; ++k) {
    const Twist t{0.1 * std::sin(1.3 * k), 0.1 * std::cos(2.1 * k), 0.5 * std::sin(0.7 * k + 1)};
    const WheelState w = inverse_kinematics(z, t);
    for (std::size_t i = 0; i < kWheelCount; ++i) {
      EXPECT_GT(w.steering[i], -kPi / 2);
      EXPECT_LE(w.steering[i], kPi / 2);
    }
    const Twist back = forward_least_squares(z, w);
    EXPECT_NEAR(back.vx, t.vx, 1e-12);
    EXPECT_NEAR(back.vy, t.vy, 1e-12);
    EXPECT_NEAR(back.omega, t.omega, 1e-12);
    const Twist simple = forward_published(nominal(), inverse_kinematics(nominal(), t));
    EXPECT_NEAR(simple.omega, t.omega, 1e-12);
  }
}

TEST(SimulateKinematics, AStandingWheelKeepsItsSteering) {
  const WheelState w = inverse_kinematics(nominal(), {}, {0.1, -0.2, 0.3, -0.4});
  EXPECT_EQ(w.steering, (PerWheel{0.1, -0.2, 0.3, -0.4}));
  EXPECT_EQ(w.speed, (PerWheel{0, 0, 0, 0}));
}

// The contact point of a wheel turned by d lies at (a - c sin d, b + c cos d).
TEST(SimulateKinematics, ContactOffsetMovesTheLever) {
  Parameters moved_b = nominal();
  for (std::size_t i = 0; i < kWheelCount; ++i) moved_b[4 + i] += 0.004;
  const WheelState ahead{{0, 0, 0, 0}, {1, 1, 2, 2}};
  for (const auto forward : {forward_published, forward_least_squares})
    EXPECT_NEAR(forward(nominal(), ahead, {0.004, 0.004, 0.004, 0.004}).omega,
                forward(moved_b, ahead, {}).omega, 1e-15);
  Parameters moved_a = nominal();
  for (std::size_t i = 0; i < kWheelCount; ++i) moved_a[i] -= 0.004;
  const WheelState sideways{{kPi / 2, kPi / 2, kPi / 2, kPi / 2}, {1, 2, 2, 1}};
  for (const auto forward : {forward_published, forward_least_squares})
    EXPECT_NEAR(forward(nominal(), sideways, {0.004, 0.004, 0.004, 0.004}).omega,
                forward(moved_a, sideways, {}).omega, 1e-15);
}

TEST(SimulateKinematics, ArcsAreExactAndSmoothAtZeroRotation) {
  const Pose quarter = moved({1, 2, 0}, {0.5, 0, kPi / 2}, 1);
  EXPECT_NEAR(quarter.x, 1 + 1 / kPi, 1e-15);
  EXPECT_NEAR(quarter.y, 2 + 1 / kPi, 1e-15);
  for (const double omega : {1e-12, 1e-7, 1e-5, 1.01e-5}) {
    const Pose a = moved({}, {1, 0, omega}, 1);
    EXPECT_NEAR(a.x, 1 - omega * omega / 6, 1e-15);
    EXPECT_NEAR(a.y, omega / 2, 1e-15 + omega * omega * omega);
  }
}

TEST(SimulateDrives, TheSixReferencesMatchTo1e12) {
  ODOBENCH_NEEDS_SHARED();
  const nlohmann::json reference = testing::reference_json("simulator.json").at("references");
  const std::vector<Drive> drives = reference_drives();
  ASSERT_EQ(reference.size(), drives.size());
  for (std::size_t k = 0; k < drives.size(); ++k) {
    EXPECT_EQ(drives[k].name, reference[k].at("name"));
    EXPECT_EQ(drives[k].duration(), reference[k].at("T").get<double>());
    expect_twist(drives[k].phases.at(0).twist, reference[k].at("twist"), drives[k].name);
    for (const auto& row : reference[k].at("poses")) {
      const Pose pose = drives[k].reference(row.at(0).get<double>());
      EXPECT_NEAR(pose.x, row.at(1).get<double>(), 1e-12) << drives[k].name;
      EXPECT_NEAR(pose.y, row.at(2).get<double>(), 1e-12) << drives[k].name;
      EXPECT_NEAR(pose.theta, row.at(3).get<double>(), 1e-12) << drives[k].name;
    }
  }
}

TEST(SimulateDrives, PhasesFollowEachOther) {
  const Drive drive{"l", "", {{{1, 0, 0}, 2}, {{0, 0, kPi / 2}, 1}, {{1, 0, 0}, 3}}, {}, {1, 1, 1, 1}};
  EXPECT_DOUBLE_EQ(drive.duration(), 6);
  const Pose end = drive.reference(10);
  EXPECT_NEAR(end.x, 2, 1e-12);
  EXPECT_NEAR(end.y, 3, 1e-12);
  EXPECT_EQ(drive.reference_twist(2.5).omega, kPi / 2);
  EXPECT_EQ(drive.reference_twist(6).vx, 0);
}

TEST(SimulateExact, EndsWhereTheAnalysisSays) {
  ODOBENCH_NEEDS_SHARED();
  const nlohmann::json reference = testing::reference_json("simulator.json").at("exact_recordings");
  const std::vector<Drive> drives = reference_drives();
  std::size_t cases = 0;
  for (const auto& entry : reference.at("cases")) {
    const RecordingScenario s =
        exact_scenario(parameters(reference.at("truths").at(entry.at("p").get<std::string>())),
                       entry.at("truth") == "thesis" ? Kinematics::Published : Kinematics::LeastSquares);
    const Drive& drive = drives.at(entry.at("traj").get<std::size_t>() - 1);
    const WheelState command = inverse_kinematics(nominal(), drive.phases[0].twist);
    expect_twist(true_twist(s.truth, command), entry.at("true_twist"), drive.name);
    const Recording r = exact_recording(s, drive);
    EXPECT_NEAR(r.reference.x.back(), entry.at("end_pose")[0].get<double>(), 1e-10) << drive.name;
    EXPECT_NEAR(r.reference.y.back(), entry.at("end_pose")[1].get<double>(), 1e-10) << drive.name;
    EXPECT_NEAR(r.reference.theta.back(), entry.at("end_pose")[2].get<double>(), 1e-10) << drive.name;
    ++cases;
  }
  EXPECT_EQ(cases, 24u);
}

TEST(SimulateExact, PosesAndCostsMatchTo1e9) {
  ODOBENCH_NEEDS_SHARED();
  const nlohmann::json reference = testing::reference_json("exact_recordings.json");
  const RecordingScenario s = exact_scenario(parameters(reference.at("p_true")), Kinematics::Published);
  const SimulatedSet set = simulate_set(s, 1, 1);
  const Vector truth = Eigen::Map<const Vector>(s.truth.parameters.data(), 12);
  const Parameters z = nominal();
  const Vector start = Eigen::Map<const Vector>(z.data(), 12);
  const double more[] = {424.1961532, 33.02858371, 33.02858371};  // trajectories 4 to 6, ten digits
  for (std::size_t k = 0; k < 6; ++k) {
    const Recording& r = set.dataset.recordings[k];
    const std::vector<Recording> one = {r};
    if (k >= 3) {
      EXPECT_NEAR(direct::cost(one, start), more[k - 3], 1e-9 * more[k - 3]) << r.id;
      continue;
    }
    const auto& expected = reference.at("expected")[k];
    ASSERT_EQ(r.size(), expected.at("rows").get<std::size_t>());
    EXPECT_NEAR(direct::cost(one, start), expected.at("J_nominal").get<double>(),
                1e-9 * expected.at("J_nominal").get<double>());
    EXPECT_NEAR(direct::cost(one, truth), expected.at("J_true").get<double>(), 1e-9);
    std::ifstream file(testing::shared_folder() / "reference" / fmt::format("exact_recording_{}.csv", k + 1));
    std::string line;
    std::getline(file, line);
    double worst = 0;
    for (std::size_t row = 0; std::getline(file, line); ++row) {
      std::array<double, 12> v{};
      std::size_t at = 0;
      for (double& value : v) {
        value = std::stod(line.substr(at));
        at = line.find(',', at) + 1;
      }
      worst = std::max(worst, std::abs(static_cast<double>(r.time_us.at(row)) * 1e-6 - v[0]));
      for (std::size_t i = 0; i < kWheelCount; ++i) {
        worst = std::max(worst, std::abs(steering_of(r, i)[row] - v[1 + i]));
        worst = std::max(worst, std::abs(wheel_speed_of(r, i)[row] - v[5 + i]));
      }
      worst = std::max({worst, std::abs(r.reference.x[row] - v[9]), std::abs(r.reference.y[row] - v[10]),
                        std::abs(r.reference.theta[row] - v[11])});
    }
    EXPECT_LE(worst, 1e-9) << r.id;
  }
}

}  // namespace
}  // namespace odobench::simulate
