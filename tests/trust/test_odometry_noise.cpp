// The noise of odometry: found again where it is known, honest on drives that it has not seen.
#include "problems/trust/odometry_noise.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cstdlib>
#include <numbers>

#include "base/random.hpp"
#include "problems/calibration/calibration_problem.hpp"
#include "problems/simulation/demo_generator.hpp"
#include "problems/simulation/robot_simulator.hpp"
#include "tests/support/data/vitko_problem.hpp"

namespace odobench {
namespace {

struct Way {
  const char* name;
  std::vector<RobotPhase> phases;  // vx, vy, omega, seconds
};
std::vector<Way> ways() {
  const double half = std::numbers::pi / 2;
  return {{"line", {{0.2, 0, 0, 20}}},
          {"sideways", {{0, 0.2, 0, 20}}},
          {"spin", {{0, 0, 0.4, 31.4}}},
          {"square", {{0.2, 0, 0, 7.5}, {0, 0, 0.4, half / 0.4}, {0.2, 0, 0, 7.5}, {0, 0, 0.4, half / 0.4}}},
          {"circle", {{0.2, 0, 0.4, 20}}}};
}

NoiseModel known_model() {
  NoiseModel m;
  m.value = {4e-6, 1e-6, 9e-6, 2e-6, 2e-6, 2e-5, 4e-8, 4e-8, 0, 3e-6, 0, 0, 2e-6};
  return m;
}

void step(PoseTrack& track, const Eigen::Vector3d& motion) {
  const double theta = track.theta.back() + motion[2] / 2;
  track.x.push_back(track.x.back() + std::cos(theta) * motion[0] - std::sin(theta) * motion[1]);
  track.y.push_back(track.y.back() + std::sin(theta) * motion[0] + std::cos(theta) * motion[1]);
  track.theta.push_back(track.theta.back() + motion[2]);
}

// The odometry says the way, the truth differs by increments of the model and, in every repetition alike, by
// `bias` of its motion. Every `every`-th sample of 100 Hz is kept: the truth is the same for all.
NoiseDrive drive_of(const Way& way, const NoiseModel& model, double bias, int every, Random& random) {
  PoseTrack odometry{{0}, {0}, {0.3}}, truth{{0}, {0}, {0.3}};
  for (const RobotPhase& p : way.phases)
    for (int k = 0; k < static_cast<int>(std::lround(100 * p.seconds)); ++k) {
      const Eigen::Vector3d motion = Eigen::Vector3d(p.vx, p.vy, p.omega) / 100;
      const Eigen::LLT<Eigen::Matrix3d> factor(model.increment(motion[0], motion[1], motion[2]) +
                                               1e-18 * Eigen::Matrix3d::Identity());
      const Eigen::Vector3d white(random.normal(), random.normal(), random.normal());
      step(odometry, motion);
      step(truth, (1 + bias) * motion - factor.matrixL() * white);
    }
  NoiseDrive out;
  out.trajectory = way.name;
  const double position = std::sqrt(model.value[kCapturePosition]),
               heading = std::sqrt(model.value[kCaptureHeading]);
  for (std::size_t k = 0; k < truth.x.size(); ++k) {
    const double dx = random.normal(position), dy = random.normal(position), dtheta = random.normal(heading);
    if (k % static_cast<std::size_t>(every) != 0) continue;
    out.rows.push_back(out.rows.size());
    out.time_s.push_back(0.01 * static_cast<double>(k));
    for (const auto& [to, from] : {std::pair(&out.odometry, &odometry), std::pair(&out.reference, &truth)}) {
      to->x.push_back(from->x[k]);
      to->y.push_back(from->y[k]);
      to->theta.push_back(from->theta[k]);
    }
    out.reference.x.back() += dx;
    out.reference.y.back() += dy;
    out.reference.theta.back() += dtheta;
  }
  return out;
}

std::vector<NoiseDrive> set_of(const std::vector<Way>& kinds, int repetitions, std::uint64_t seed,
                               double bias = 0, int every = 5) {
  std::vector<NoiseDrive> drives;
  for (const Way& way : kinds)
    for (int r = 0; r < repetitions; ++r) {
      Random random(mixed_seed(seed, drives.size()));
      drives.push_back(drive_of(way, known_model(), bias, every, random));
      drives.back().id = fmt::format("{}_{}", way.name, r + 1);
    }
  return drives;
}

constexpr NoiseOptions kValuesOnly{false, false, false};

void expect_share(const NoiseFit& fit, const NoiseModel& known, std::initializer_list<int> terms,
                  double share) {
  ASSERT_EQ(fit.refused, "");
  for (const int t : terms)
    EXPECT_NEAR(fit.model.value[t], known.value[t], share * std::abs(known.value[t]))
        << noise_terms()[t].name;
}

TEST(OdometryNoise, IsFoundWhereItIsKnown) {
  const NoiseFit fit = fit_odometry_noise(set_of(ways(), 12, 1), kValuesOnly);
  expect_share(fit, known_model(),
               {kAlong, kAcross, kHeading, kForward, kSideways, kTurn, kAlongHeading, kSidewaysTurn}, 0.2);
  EXPECT_TRUE(fit.separated);
  EXPECT_NEAR(fit.typical.turn_rate, 0.4, 0.004);
}

TEST(OdometryNoise, WhatRepeatsIsNoNoise) {
  const std::vector<NoiseDrive> drives = set_of(ways(), 8, 1, 0.02);
  const NoiseFit plain = fit_odometry_noise(set_of(ways(), 8, 1), kValuesOnly),
                 biased = fit_odometry_noise(drives, kValuesOnly),
                 total = fit_odometry_noise(drives, {false, false, true});
  for (const int t : {kAlong, kHeading, kTurn})
    EXPECT_NEAR(biased.model.value[t], plain.model.value[t], 0.05 * plain.model.value[t])
        << noise_terms()[t].name;
  EXPECT_GT(total.model.value[kAlong], 5 * plain.model.value[kAlong]);
  EXPECT_FALSE(total.separated);
  // 2 % of 4 m: the truth goes further than the odometry says.
  ASSERT_EQ(biased.kinds.front().trajectory, "line");
  EXPECT_NEAR(biased.kinds.front().bias[0], -0.08, 0.01);
}

TEST(OdometryNoise, DoesNotDependOnTheSampling) {
  const NoiseFit dense = fit_odometry_noise(set_of(ways(), 8, 3, 0, 5), kValuesOnly),
                 sparse = fit_odometry_noise(set_of(ways(), 8, 3, 0, 10), kValuesOnly);
  for (const int t : {kAlong, kHeading, kForward, kSideways, kTurn})
    EXPECT_NEAR(sparse.model.value[t], dense.model.value[t], 0.05 * dense.model.value[t])
        << noise_terms()[t].name;
}

// A capture that loses the robot now and then.
TEST(OdometryNoise, StandsLostSamples) {
  std::vector<NoiseDrive> drives = set_of(ways(), 8, 4);
  const NoiseFit clean = fit_odometry_noise(drives, kValuesOnly);
  for (std::size_t n = 0; n < drives.size(); n += 4)
    for (std::size_t k = 100; k < 112; ++k) drives[n].reference.x[k] += 0.3;
  const NoiseFit spoilt = fit_odometry_noise(drives, kValuesOnly);
  EXPECT_GT(spoilt.held_back, 3);
  EXPECT_EQ(clean.held_back, 0);
  for (const int t : {kAlong, kHeading, kForward, kTurn})
    EXPECT_NEAR(spoilt.model.value[t], clean.model.value[t], 0.2 * clean.model.value[t])
        << noise_terms()[t].name;
}

struct NoisyRobot {
  Robot robot;
  Vector z;
  double wheel = 4e-6;  // m^2 per metre of each wheel
  std::vector<RobotDrive> drives;
};

// Clean wheels, and as reference the path of wheels that turned by a white error more.
NoiseFit fit_of(const NoisyRobot& of, int repetitions) {
  RobotNoise quiet;
  quiet.drive_wander = quiet.steering_wander = 0;
  quiet.counts = 1e7;
  const RobotSimulator simulator(of.robot, quiet);
  const RobotAbilities can = simulator.abilities(of.z);
  std::vector<Recording> clean, noisy;
  for (const RobotDrive& drive : of.drives)
    for (int r = 0; r < repetitions; ++r) {
      Random random(mixed_seed(7, clean.size()));
      Recording recording = simulator.record(drive, can, of.z, of.z, random).recording;
      recording.id = fmt::format("{}_{}", drive.name, r + 1);
      recording.trajectory = drive.name;
      recording.repetition = r + 1;
      clean.push_back(recording);
      const double radius = 0.05;
      for (Signal& signal : recording.signals) {
        if (signal.kind == SignalKind::Angle) continue;
        for (std::size_t k = 0; k < signal.values.size(); ++k) {
          const double hold = signal.kind == SignalKind::Speed ? kRobotStep : 1;
          const double way = std::abs(signal.values[k]) * hold * radius;
          signal.values[k] += random.normal(std::sqrt(of.wheel * way)) / (radius * hold);
        }
      }
      noisy.push_back(recording);
    }
  CalibrationOptions options;
  options.rule = of.robot.rule;
  const CalibrationProblem truth(of.robot, noisy, options);
  Random capture(11);
  for (std::size_t n = 0; n < clean.size(); ++n) {
    const PoseTrack track = truth.integrate(n, of.z);
    Reference& reference = clean[n].reference;
    for (std::size_t k = 0; k < track.x.size(); ++k) {
      reference.x[k] = track.x[k] + capture.normal(1e-4);
      reference.y[k] = track.y[k] + capture.normal(1e-4);
      reference.theta[k] = track.theta[k] + capture.normal(1e-4);
    }
  }
  const CalibrationProblem problem(of.robot, clean, options);
  return fit_odometry_noise(noise_drives(problem, of.z), kValuesOnly);
}

std::vector<RobotDrive> lines_and_spins(bool sideways) {
  std::vector<RobotDrive> drives = {{"line", "", {{0.25, 0, 0, 16}}},
                                    {"back", "", {{-0.25, 0, 0, 16}}},
                                    {"left", "", {{0, 0, 0.5, 20}}},
                                    {"right", "", {{0, 0, -0.5, 20}}}};
  if (sideways) drives.push_back({"sideways", "", {{0, 0.25, 0, 16}}});
  return drives;
}

// Wheels at +-b/2: (e_r + e_l)/2 and (e_r - e_l)/b.
TEST(OdometryNoise, OfADifferentialDrive) {
  NoisyRobot of;
  of.robot = robot_of_class("differential", {});
  of.z = nominal_values(of.robot);  // b 0.3 m, radii 0.05 m
  of.drives = lines_and_spins(false);
  const double b = of.z[0], k = of.wheel;
  ASSERT_NEAR(of.z[1], 0.05, 1e-9);
  NoiseModel known;
  known.value[kAlong] = k / 2;
  known.value[kHeading] = 2 * k / (b * b);
  known.value[kForward] = k * b / 4;
  known.value[kTurn] = k / b;
  const NoiseFit fit = fit_of(of, 15);
  expect_share(fit, known, {kAlong, kHeading, kForward, kTurn}, 0.2);
  EXPECT_LT(fit.model.value[kAcross], 0.02 * k);
  EXPECT_LT(fit.model.value[kSideways], 0.02 * k * b);
}

// Rollers at 45 degrees: every wheel turns by the way, or by (lx + ly) times the angle.
TEST(OdometryNoise, OfAMecanumRobot) {
  NoisyRobot of;
  of.robot = robot_of_class("mecanum", {});
  of.z = nominal_values(of.robot);
  of.drives = lines_and_spins(true);
  double arm = 0;
  for (std::size_t i = 0; i < of.robot.parameters.size(); ++i)
    if (of.robot.parameters[i].name == "lx" || of.robot.parameters[i].name == "ly")
      arm += of.z[static_cast<Eigen::Index>(i)];
  const double k = of.wheel / 4;
  NoiseModel known;
  known.value = {k, k, k / (arm * arm), k * arm, k * arm, k / arm};
  expect_share(fit_of(of, 15), known, {kAlong, kAcross, kHeading, kForward, kSideways, kTurn}, 0.2);
}

// (2.16)-(2.17) of the thesis with a = b: steering is exact, so driving errs along the way and in heading.
TEST(OdometryNoise, OfFourSteeredWheels) {
  NoisyRobot of;
  of.robot = robot_of_class("4wis4wid", {});
  of.z = nominal_values(of.robot);
  of.drives = lines_and_spins(true);
  // fit_of() takes radii of 0.05 m: increments of noise in rad go with 1 / radius, ways with it.
  const double radius = of.z[8], a = of.z[0], arm = std::sqrt(2.0) * a, scale = radius / 0.05;
  const double k = of.wheel * scale;
  NoiseModel known;
  known.value[kAlong] = k / 4;
  known.value[kHeading] = k / 4 * std::pow(1 / (2 * a), 2);
  known.value[kForward] = known.value[kSideways] = k / 8 * arm;
  known.value[kTurn] = k / 4 / arm;
  const NoiseFit fit = fit_of(of, 15);
  expect_share(fit, known, {kAlong, kHeading, kForward, kSideways, kTurn}, 0.2);
  EXPECT_LT(fit.model.value[kAcross], 0.02 * k);
}

std::vector<Way> short_ways() {
  const double half = std::numbers::pi / 2;
  return {{"line", {{0.2, 0, 0, 10}}},
          {"sideways", {{0, 0.2, 0, 10}}},
          {"spin", {{0, 0, 0.4, 10}}},
          {"corner", {{0.2, 0, 0, 5}, {0, 0, 0.4, half / 0.4}, {0.2, 0, 0, 5}}}};
}

// ODOBENCH_NOISE_SETS=100 makes it a hundred sets, and prints what became of them.
TEST(OdometryNoise, LeftOutDrivesAreInsideTheBand) {
  const char* more = std::getenv("ODOBENCH_NOISE_SETS");
  const int sets = more != nullptr ? std::atoi(more) : 20;
  int inside = 0, held = 0;
  std::array<int, kNoiseTerms> each{};
  const NoiseModel known = known_model();
  for (int s = 0; s < sets; ++s) {
    const NoiseFit fit =
        fit_odometry_noise(set_of(short_ways(), 5, 1000 + static_cast<std::uint64_t>(s), 0.01, 10));
    inside += fit.consistent() ? 1 : 0;
    for (int t = 0; t < kNoiseTerms; ++t)
      each[t] += known.value[t] >= fit.terms[t].lower && known.value[t] <= fit.terms[t].upper ? 1 : 0;
  }
  for (const int t : {kAlong, kAcross, kHeading, kForward, kSideways, kTurn}) held += each[t];
  EXPECT_GE(inside, sets * 9 / 10);
  EXPECT_GE(held, sets * 6 * 9 / 10);
  if (!more) return;
  fmt::print("NEES inside its band in {} of {} sets\n", inside, sets);
  for (int t = 0; t < kNoiseTerms; ++t)
    fmt::print("{:30s} in its interval {}\n", noise_terms()[t].name, each[t]);
}

// A gain of the wheels that differs from drive to drive is no white noise, and the check says so.
TEST(OdometryNoise, OtherErrorsAreSeen) {
  std::vector<NoiseDrive> drives = set_of(short_ways(), 6, 5, 0, 10);
  Random random(3);
  for (NoiseDrive& drive : drives) {
    const double gain = 1 + random.normal(0.02);
    for (std::size_t k = 0; k < drive.reference.x.size(); ++k) {
      drive.reference.x[k] *= gain;
      drive.reference.y[k] *= gain;
    }
  }
  const NoiseFit fit = fit_odometry_noise(drives);
  EXPECT_GT(fit.nees, 1.5 * 3);
  ASSERT_EQ(fit.lengths.size(), 4u);
  EXPECT_GT(fit.lengths.back().ratio, 1.2 * fit.lengths.front().ratio);
}

// The second way: the fitted model, simulated, scatters as its propagation says and as the drives do.
TEST(OdometryNoise, SimulatedAgainGivesTheScatterOfTheEnds) {
  const NoiseFit fit = fit_odometry_noise(set_of(short_ways(), 12, 6, 0, 10), kValuesOnly);
  for (const Way& way : short_ways()) {
    NoiseModel model = fit.model;
    model.value[kCapturePosition] = model.value[kCaptureHeading] = model.value[kCaptureStamp] = 0;
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    constexpr int kRuns = 600;
    PoseTrack odometry;
    for (int n = 0; n < kRuns; ++n) {
      Random random(mixed_seed(17, static_cast<std::uint64_t>(n)));
      const NoiseDrive drive = drive_of(way, model, 0, 20, random);
      const PoseTrack &q = drive.odometry, &r = drive.reference;
      const double dx = q.x.back() - r.x.back(), dy = q.y.back() - r.y.back(), c = std::cos(0.3),
                   s = std::sin(0.3);
      const Eigen::Vector3d e(c * dx + s * dy, c * dy - s * dx, q.theta.back() - r.theta.back());
      sum += e * e.transpose() / kRuns;
      odometry = q;
    }
    const Eigen::Matrix3d predicted = propagated_noise(model, odometry);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j <= i; ++j)
        EXPECT_NEAR(sum(i, j), predicted(i, j), 0.2 * std::sqrt(predicted(i, i) * predicted(j, j)))
            << way.name << ' ' << i << ' ' << j;
    for (const NoiseKind& kind : fit.kinds)
      if (kind.trajectory == way.name) {
        EXPECT_NEAR(kind.scatter[2], std::sqrt(predicted(2, 2)), 0.5 * std::sqrt(predicted(2, 2)))
            << way.name;
      }
  }
}

TEST(OdometryNoise, StraightLinesSayNothingOfTurning) {
  const NoiseFit fit = fit_odometry_noise(set_of({ways()[0], ways()[1]}, 8, 2), kValuesOnly);
  for (const int t : {kForward, kSideways, kTurn, kForwardTurn, kSidewaysTurn}) {
    EXPECT_EQ(fit.model.value[t], 0);
    EXPECT_NE(fit.terms[static_cast<std::size_t>(t)].undetermined.find("turn by"), std::string::npos);
  }
  expect_share(fit, known_model(), {kAlong, kHeading}, 0.25);
}

TEST(OdometryNoise, SpinsSayNothingOfDriving) {
  const NoiseFit fit = fit_odometry_noise(set_of({ways()[2]}, 12, 2), kValuesOnly);
  EXPECT_NE(fit.terms[kAlong].undetermined.find("travel"), std::string::npos);
  expect_share(fit, known_model(), {kTurn}, 0.25);
}

TEST(OdometryNoise, CirclesOfOneSizeDoNotTellThemApart) {
  const NoiseFit fit = fit_odometry_noise(set_of({ways()[4]}, 12, 2), kValuesOnly);
  EXPECT_NE(fit.terms[kTurn].undetermined.find("one proportion"), std::string::npos);
  // 2 rad per metre.
  const NoiseModel known = known_model();
  EXPECT_NEAR(fit.model.value[kHeading], known.value[kHeading] + 2 * known.value[kTurn], 1.5e-5);
}

TEST(OdometryNoise, RefusesWithReasons) {
  EXPECT_NE(fit_odometry_noise(set_of({ways()[0]}, 3, 1)).refused.find("3 drives"), std::string::npos);
  std::vector<NoiseDrive> still = set_of({ways()[0]}, 5, 1);
  for (NoiseDrive& drive : still) {
    for (auto* v : {&drive.odometry.x, &drive.odometry.y}) std::fill(v->begin(), v->end(), 0);
  }
  EXPECT_NE(fit_odometry_noise(still).refused, "");
  EXPECT_EQ(fit_odometry_noise(set_of({ways()[0]}, 4, 1), kValuesOnly).refused, "");
}

// The demo set is made with a capture of 0.15 mm and 0.05 mrad, and wheels that do what they say.
TEST(OdometryNoise, OfTheCaptureIsKeptApart) {
  const Dataset set = make_demo_dataset();
  const CalibrationProblem problem(testing::parameters_of(set), set.recordings);
  const std::vector<double>& truth = set.known_parameters.front().values;
  const NoiseFit fit = fit_odometry_noise(
      noise_drives(problem, Eigen::Map<const Vector>(truth.data(), static_cast<Eigen::Index>(truth.size()))));
  EXPECT_NEAR(std::sqrt(fit.model.value[kCapturePosition]), 1.5e-4, 1e-5);
  EXPECT_NEAR(std::sqrt(fit.model.value[kCaptureHeading]), 5e-5, 4e-6);
  for (const int t : {kAlong, kAcross, kForward, kSideways}) EXPECT_LT(fit.model.value[t], 1e-8);
  for (const int t : {kHeading, kTurn}) EXPECT_LT(fit.model.value[t], 1e-9);
  for (const int t : {kAlong, kAcross, kHeading, kForward, kSideways, kTurn})
    EXPECT_GT(fit.terms[static_cast<std::size_t>(t)].upper, 0) << "no spread is no precision";
}

TEST(OdometryNoise, OtherWaysAreNoRepetitions) {
  std::vector<NoiseDrive> drives = set_of(ways(), 1, 1);
  for (NoiseDrive& drive : drives) drive.trajectory = "free";
  const NoiseFit fit = fit_odometry_noise(drives, kValuesOnly);
  EXPECT_FALSE(fit.separated);
  EXPECT_FALSE(fit.kinds.front().repeated);
  EXPECT_EQ(fit.kinds.front().bias.norm(), 0);
}

// A tape measure at the end: nothing tells its noise from the wheels'.
TEST(OdometryNoise, EndsAloneAreEnough) {
  std::vector<NoiseDrive> drives = set_of(ways(), 30, 2, 0, 20);
  for (NoiseDrive& drive : drives) {
    const PoseTrack r = drive.reference;
    drive.rows = {0, r.x.size() - 1};
    drive.reference = {
        {r.x.front(), r.x.back()}, {r.y.front(), r.y.back()}, {r.theta.front(), r.theta.back()}};
  }
  const NoiseFit fit = fit_odometry_noise(drives, kValuesOnly);
  EXPECT_NE(fit.terms[kCapturePosition].undetermined, "");
  const NoiseModel known = known_model();
  EXPECT_NEAR(fit.model.value[kTurn], known.value[kTurn], 0.5 * known.value[kTurn]);
}

TEST(OdometryNoise, TwistAndAmclAgreeWithTheModel) {
  const NoiseModel m = known_model();
  const Eigen::Matrix3d q = twist_covariance(m, 0.5, 0, -0.2, 0.02);
  EXPECT_NEAR(q(0, 0), (0.5 * m.value[kAlong] + 0.2 * m.value[kForward]) / 0.02, 1e-15);
  EXPECT_NEAR(q(2, 2), (0.5 * m.value[kHeading] + 0.2 * m.value[kTurn]) / 0.02, 1e-15);
  // Travelling sideways, the travel's own directions turn with it.
  EXPECT_NEAR(twist_covariance(m, 0, 0.5, 0, 0.02)(1, 1), 0.5 * m.value[kAlong] / 0.02, 1e-15);
  EXPECT_THROW((void)twist_covariance(m, 1, 0, 0, 0), std::invalid_argument);
  // An update of amcl: rotation, translation, rotation, each with its own noise.
  const double d = 0.25, a = 0.2;
  const std::array<double, 5> alpha = amcl_alphas(m, false, d, a), omni = amcl_alphas(m, true, d, a);
  EXPECT_NEAR(2 * alpha[1] * d * d, m.value[kHeading] * d, 1e-18);
  EXPECT_NEAR(alpha[0] * a * a, m.value[kTurn] * a, 1e-18);
  EXPECT_NEAR(alpha[2] * d * d, m.value[kAlong] * d, 1e-18);
  EXPECT_NEAR(omni[1] * d * d, m.value[kHeading] * d, 1e-18);
  EXPECT_NEAR(omni[3] * a * a, m.value[kTurn] * a, 1e-18);
  EXPECT_NEAR(omni[4] * d * d, m.value[kAcross] * d, 1e-18);
}

// The stamps of the capture scatter by 10 ms (its messages wait for a grid), which the fit finds by itself.
TEST(OdometryNoise, OfThePublishedDrives) {
  ODOBENCH_NEEDS_SHARED();
  const auto model = testing::vitko_model();
  for (const NamedParameters& set : testing::vitko_dataset().known_parameters) {
    if (set.name != "published:ip") continue;
    const Vector z = Eigen::Map<const Vector>(set.values.data(), 12);
    const NoiseFit fit = fit_odometry_noise(noise_drives(*model, z));
    EXPECT_TRUE(fit.consistent()) << fit.nees;
    EXPECT_NEAR(std::sqrt(fit.model.value[kCaptureStamp]), 0.012, 0.003);
    EXPECT_NEAR(std::sqrt(fit.model.value[kHeading]), 0.0025, 0.0008);
    for (const NoiseLength& length : fit.lengths) EXPECT_NEAR(length.ratio, 1, 0.15);
  }
}

}  // namespace
}  // namespace odobench
