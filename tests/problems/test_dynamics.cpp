// Motor and four-wheel robot: against independent solutions, against what physics demands, and what bad input
// gets.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "problems/simulation/motors/drive.hpp"
#include "problems/simulation/motors/sensors.hpp"
#include "tests/support/data/report_records.hpp"
#include "tests/support/data_error.hpp"
#include "tests/support/run_process.hpp"
#include "tests/support/shared_data.hpp"

namespace odobench::dynamics {
namespace {

using ::testing::HasSubstr;

constexpr ModelOptions kReferenceModel{true, false, false};  // of the vectors with r in the torque

DriveSetup setup_of(const std::string& set, const std::string& name, ModelOptions model = {}) {
  return {robot_set(set), model, {}, experiment(name)};
}

// (2.3)-(2.4) from the eigenvalues: i and w after a step to `u` from rest.
MotorState exact_step(const MotorParameters& p, double u, double t) {
  const double a = p.resistance / p.inductance, d = p.bearing_loss / p.inertia;
  const double bc = p.flux_constant * p.flux_constant / (p.inductance * p.inertia);
  const double root = std::sqrt((a - d) * (a - d) / 4 - bc);
  const double l1 = -(a + d) / 2 - root, l2 = -(a + d) / 2 + root;
  const MotorState end = motor_steady_state(p, u);
  // w = w_end + A e^(l1 t) + B e^(l2 t), w(0) = w'(0) = 0
  const double big = end.speed / (l2 - l1);
  const double w = end.speed + big * (-l2 * std::exp(l1 * t) + l1 * std::exp(l2 * t));
  const double rate = big * l1 * l2 * (std::exp(l2 * t) - std::exp(l1 * t));
  return {(p.inertia * rate + p.bearing_loss * w) / p.flux_constant, w};
}

double exact_angle(const MotorParameters& p, double u, double t) {
  const double a = p.resistance / p.inductance, d = p.bearing_loss / p.inertia;
  const double bc = p.flux_constant * p.flux_constant / (p.inductance * p.inertia);
  const double root = std::sqrt((a - d) * (a - d) / 4 - bc);
  const double l1 = -(a + d) / 2 - root, l2 = -(a + d) / 2 + root;
  const double end = motor_steady_state(p, u).speed;
  return end * t + end / (l2 - l1) * (-l2 / l1 * std::expm1(l1 * t) + l1 / l2 * std::expm1(l2 * t));
}

TEST(Dynamics, TheMotorFollowsItsClosedForm) {
  DriveSetup setup = setup_of("grip", "exp1_steered", kReferenceModel);
  setup.segments = {{1, {6, 6, 6, 6}, {}, false}};
  setup.integration.relative_tolerance = 1e-12;
  const std::vector<Sample> samples = simulate_drive(setup, 0.005);
  for (const Sample& s : samples) {
    const MotorState exact = exact_step(setup.robot.motor, 6, s.time_s);
    EXPECT_NEAR(s.state[kCurrent], exact.current, 1e-8) << s.time_s;
    EXPECT_NEAR(s.state[kSpeed + 3], exact.speed, 1e-9) << s.time_s;
    EXPECT_NEAR(s.state[kAngle + 2], exact_angle(setup.robot.motor, 6, s.time_s), 1e-10) << s.time_s;
  }
  EXPECT_NEAR(motor_steady_state(setup.robot.motor, 6).speed, 6.486486486486486, 1e-12);
  EXPECT_NEAR(motor_steady_state(setup.robot.motor, 6).current, 0.4054054054054054, 1e-12);
}

class ReferenceRuns : public ::testing::TestWithParam<Method> {};

TEST_P(ReferenceRuns, AreMatchedTo1e8) {
  ODOBENCH_NEEDS_SHARED();
  std::string text = testing::content(testing::shared_folder() / "reference" / "dynamics.json");
  for (std::size_t at = 0; (at = text.find("Infinity", at)) != std::string::npos;)
    text.replace(at, 8, "null");
  const nlohmann::json reference =
      nlohmann::json::parse(text);  // a straight line has a radius that JSON has no word for
  std::size_t runs = 0;
  double worst = 0;
  for (const auto& run : reference.at("runs")) {
    const std::string name = run.at("experiment");
    DriveSetup setup = setup_of(run.at("set"), name, {run.at("torque_with_r"), false, false});
    setup.integration.method = GetParam();
    setup.integration.relative_tolerance = 1e-12;
    setup.integration.absolute_tolerance = 1e-13;
    const std::vector<Sample> samples = simulate_drive(setup, 0.5);
    ASSERT_EQ(samples.size(), run.at("rows").size());
    for (std::size_t k = 0; k < samples.size(); ++k)
      for (std::size_t c = 0; c < 14; ++c)
        worst = std::max(worst, std::abs(samples[k].state[c] - run.at("rows")[k][c + 1].get<double>()));
    EXPECT_LE(worst, 1e-8) << run.at("set") << " " << name;
    const Balance b = balance(setup.robot, samples.back().state);
    EXPECT_LE(std::abs(b.body), 1e-6) << name;
    // Fixed steps lose this much in the first milliseconds, as the reference's own balance does.
    EXPECT_LE(std::abs(b.motor), GetParam() == Method::RungeKutta4 ? 2e-4 : 1e-6) << name;
    EXPECT_NEAR(samples.back().state[kDrive], run.at("energy").at("work_into_body_J").get<double>(),
                1e-4 * samples.back().state[kDrive]);
    ++runs;
  }
  EXPECT_EQ(runs, 10u);
  RecordProperty("worst", fmt::format("{:.2g}", worst));
}
INSTANTIATE_TEST_SUITE_P(Dynamics, ReferenceRuns,
                         ::testing::Values(Method::RungeKutta4, Method::DormandPrince), [](const auto& i) {
                           return i.param == Method::RungeKutta4 ? "RungeKutta4" : "DormandPrince";
                         });

TEST(Dynamics, RungeKutta4HasOrderFour) {
  DriveSetup setup = setup_of("hint", "exp2_circle", kReferenceModel);
  setup.segments.back().until_s = 1;
  setup.integration = {Method::DormandPrince, 1e-4, 1e-13, 1e-15};
  const State exact = simulate_drive(setup, 1).back().state;
  const auto error = [&](double step) {
    setup.integration = {Method::RungeKutta4, step, 1e-10, 1e-12};
    const State state = simulate_drive(setup, 1).back().state;
    double worst = 0;
    for (std::size_t c = 0; c <= kOmega; ++c) worst = std::max(worst, std::abs(state[c] - exact[c]));
    return worst;
  };
  EXPECT_NEAR(std::log2(error(0.004) / error(0.002)), 4, 0.6);
}

// Every combination of corrections: equal voltages and wheels ahead leave nothing to turn or push aside.
TEST(Dynamics, TheSymmetricRunStaysExactlyStraight) {
  for (const ModelOptions model : {ModelOptions{}, ModelOptions::as_published(), kReferenceModel,
                                   ModelOptions{true, true, false}, ModelOptions{true, false, true}}) {
    DriveSetup setup = setup_of("grip", "exp1_steered", model);
    setup.segments = {{20, {6, 6, 6, 6}, {}, false}};
    for (const Sample& s : simulate_drive(setup, 0.5))
      for (const std::size_t c : {kY, kVy, kTheta, kOmega}) EXPECT_EQ(s.state[c], 0.0) << c;
  }
}

TEST(Dynamics, BalancesCloseForEveryModel) {
  for (const ModelOptions model : {ModelOptions{}, ModelOptions::as_published(), kReferenceModel,
                                   ModelOptions{true, true, false}, ModelOptions{true, false, true}})
    for (const std::string set : {"grip", "hint"})
      for (const std::string name : {"exp1_steered", "exp2_circle", "exp3_arc_then_straight"}) {
        const DriveSetup setup = setup_of(set, name, model);
        for (const Sample& s : simulate_drive(setup, 5)) {
          const Balance b = balance(setup.robot, s.state);
          EXPECT_LE(std::abs(b.body), 1e-6) << set << name << s.time_s;
          EXPECT_LE(std::abs(b.motor), 1e-6) << set << name << s.time_s;
        }
      }
}

// Erratum: without a load torque the body receives more than the motors are given; with it no energy is free.
TEST(Dynamics, OnlyTheLoadTorqueMakesEnergyCostSomething) {
  const State free = simulate_drive(setup_of("grip", "exp1_steered", kReferenceModel), 50).back().state;
  EXPECT_GT(free[kDrive], free[kElectrical]);
  const State paid = simulate_drive(setup_of("grip", "exp1_steered"), 50).back().state;
  EXPECT_LT(paid[kDrive], paid[kElectrical]);
  EXPECT_NEAR(paid[kLoad], paid[kDrive],
              1e-9 * paid[kDrive]);  // what the wheels lose is what the contacts get
}

// The friction of the thesis is a contact that slips as easily sideways as ahead.
TEST(Dynamics, AnIsotropicContactIsThePublishedForm) {
  DriveSetup published = setup_of("grip", "exp1_steered", kReferenceModel);
  DriveSetup contact = published;
  contact.model = {true, true, false};
  contact.robot.lateral_gain = contact.robot.drive_gain;
  const State a = simulate_drive(published, 50).back().state, b = simulate_drive(contact, 50).back().state;
  for (std::size_t c = 0; c <= kOmega; ++c) EXPECT_NEAR(a[c], b[c], 1e-9) << c;
}

TEST(Dynamics, SettlesWhereTheClosedFormSays) {
  for (const bool with_radius : {true, false}) {
    const DriveSetup setup = setup_of("grip", "exp2_circle", {with_radius, false, false});
    const State s = simulate_drive(setup, 50).back().state;
    const CircularMotion m = published_steady_state(setup.robot, with_radius, {s[4], s[5], s[6], s[7]}, {});
    EXPECT_NEAR(s[kOmega], m.omega, 1e-9);
    EXPECT_NEAR(std::hypot(s[kVx], s[kVy]), m.speed, 1e-9);
    EXPECT_NEAR(std::remainder(std::atan2(s[kVy], s[kVx]) - s[kTheta] - m.sideslip, 2 * std::numbers::pi), 0,
                1e-9);
  }
}

// With little slip the corrected robot goes where its wheels point: (6, 6, 9, 9) V turn it left.
TEST(Dynamics, TheCorrectedRobotTurnsTowardsTheSlowSide) {
  const State s = simulate_drive(setup_of("grip", "exp2_circle"), 50).back().state;
  EXPECT_GT(s[kOmega], 0.01);  // wheels that grip sideways resist
  const double sideslip = std::remainder(std::atan2(s[kVy], s[kVx]) - s[kTheta], 2 * std::numbers::pi);
  EXPECT_LT(std::abs(sideslip), 0.1);
}

TEST(Dynamics, SteeringAndVoltageMayRamp) {
  const std::vector<Segment> segments = {{2, {2, 2, 2, 2}, {}, false},
                                         {4, {6, 4, 2, 0}, {0.4, 0, 0, 0}, true}};
  const Inputs half = inputs_at(segments, 1, 3);
  EXPECT_DOUBLE_EQ(half.voltage[0], 4);
  EXPECT_DOUBLE_EQ(half.voltage[3], 1);
  EXPECT_DOUBLE_EQ(half.steering[0], 0.2);
}

TEST(Dynamics, TheFilterRunHasTheConstantsOfTheThesis) {
  const std::vector<Sample> samples = simulate_drive(setup_of("hint", "filter_run", kReferenceModel), 0.1);
  ASSERT_EQ(samples.size(), 201u);
  double largest = 0, turn = 0;
  for (std::size_t k = 1; k < samples.size(); ++k) {
    largest = std::max(largest, std::abs(samples[k].rates[kVx] - samples[k - 1].rates[kVx]));
    turn = std::max(turn, std::abs(samples[k].rates[kOmega]));
  }
  EXPECT_NEAR(largest, 0.087323643, 1e-8);
  EXPECT_NEAR(turn, 0.021388556, 1e-5);  // at the samples; the maximum lies between two of them
}

TEST(Dynamics, SensorsMatchTheReferenceRun) {
  ODOBENCH_NEEDS_SHARED();
  const DriveSetup setup = setup_of("hint", "filter_run", kReferenceModel);
  const std::vector<Sample> samples = simulate_drive(setup, 0.1);
  const SensorRun run = sense(setup.robot, samples, AccelerationFrame::Body, {0, 0, 0}, [] { return 1.0; });
  std::ifstream file(testing::shared_folder() / "reference" / "dynamics_filter_run.csv");
  std::string line;
  std::getline(file, line);
  for (std::size_t k = 0; std::getline(file, line); ++k) {
    std::vector<double> v;
    for (std::size_t at = 0; at <= line.size();) {
      const std::size_t end = std::min(line.find(',', at), line.size());
      v.push_back(std::stod(line.substr(at, end - at)));
      at = end + 1;
    }
    const SensorRow& row = run.rows.at(k);
    // The reference integrates its first interval less finely: the closed form of the motor agrees with ours.
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(row.encoder_m[i], v[1 + i], k == 1 ? 5e-8 : 1e-9) << k;
    EXPECT_NEAR(row.ax, v[7], 1e-9);
    EXPECT_NEAR(row.ay, v[8], 1e-9);
    EXPECT_NEAR(run.truth[k].ax, v[9], 1e-9);
    EXPECT_NEAR(run.truth[k].ay, v[10], 1e-9);
    EXPECT_NEAR(row.yaw_step_deg, -v[14], 1e-9);  // the file's column is clockwise
    EXPECT_NEAR(run.truth[k].dtheta_deg, -v[14], 1e-9);
  }
}

// The geometry of (2.24)-(2.28) with this numbering: wheel 3, front right, lies on the filter's x axis, wheel
// 1 opposite; a rotation moves them along y by L times the angle.
TEST(Dynamics, TheTruthMovesRigidly) {
  const DriveSetup setup = setup_of("grip", "exp1_steered");
  const SensorRun run =
      sense(setup.robot, simulate_drive(setup, 0.1), AccelerationFrame::Body, {}, [] { return 0.0; });
  const double arm = std::hypot(setup.robot.half_length, setup.robot.half_width);
  const double alpha = std::atan2(setup.robot.half_width, setup.robot.half_length);
  for (const TruthRow& row : run.truth) {
    const double half = row.dtheta_deg * std::numbers::pi / 360, r = 2 * arm * std::sin(half);
    EXPECT_NEAR(row.encoder_x[2], row.sx, 1e-12);
    EXPECT_NEAR(row.encoder_y[2], row.sy + r, 1e-12);
    EXPECT_NEAR(row.encoder_y[0], row.sy - r, 1e-12);
    EXPECT_NEAR(row.encoder_x[3], row.sx + r * std::sin(2 * alpha), 1e-12);
    EXPECT_NEAR(row.encoder_y[3], row.sy - r * std::cos(2 * alpha), 1e-12);
    EXPECT_NEAR(row.encoder_x[1], row.sx - r * std::sin(2 * alpha), 1e-12);
  }
  EXPECT_GT(run.truth.back().dtheta_deg, 1);
}

TEST(Dynamics, NoiseHasItsVariances) {
  const DriveSetup setup = setup_of("hint", "filter_run");
  std::vector<Sample> samples = simulate_drive(setup, 0.01);
  std::uint64_t calls = 0;
  const SensorRun silent =
      sense(setup.robot, samples, AccelerationFrame::World, {0, 0, 0}, [] { return 1.0; });
  const SensorRun noisy = sense(setup.robot, samples, AccelerationFrame::World, {3e-5, 0.01, 0.2},
                                [&] { return ++calls % 2 == 0 ? 1.0 : -1.0; });
  EXPECT_EQ(calls, 7 * samples.size());
  EXPECT_NEAR(std::abs(noisy.rows[5].encoder_m[2] - silent.rows[5].encoder_m[2]), std::sqrt(3e-5), 1e-12);
  EXPECT_NEAR(std::abs(noisy.rows[5].ax - silent.rows[5].ax), 0.1, 1e-12);
  EXPECT_NEAR(std::abs(noisy.rows[5].yaw_step_deg - silent.rows[5].yaw_step_deg), std::sqrt(0.2), 1e-12);
  EXPECT_EQ(silent.rows[900].ax, samples[900].rates[kVx]);  // the world frame, as the thesis takes it
}

TEST(Dynamics, CsvHasSteeringOnlyWhereThereIsSome) {
  const DriveSetup straight = setup_of("hint", "filter_run"), steered = setup_of("hint", "exp1_steered");
  const auto csv = [](const DriveSetup& setup) {
    return sensor_csv(
        sense(setup.robot, simulate_drive(setup, 1), AccelerationFrame::Body, {}, [] { return 0.0; }).rows);
  };
  EXPECT_THAT(csv(straight),
              ::testing::StartsWith("time_s,enc1_m,enc2_m,enc3_m,enc4_m,ax_m_s2,ay_m_s2,yaw_step_deg\n0,0,"));
  EXPECT_THAT(csv(steered), HasSubstr(",yaw_step_deg,psi1_rad,psi2_rad,psi3_rad,psi4_rad\n"));
}

TEST(DynamicsRefuses, ParametersThatNoRobotHas) {
  for (const ParameterDescription& d : parameter_descriptions()) {
    RobotParameters p = robot_set("grip");
    EXPECT_EQ(testing::usage_error([&] { validate(p); }), "");
    for (const double bad : {-1.0, std::nan(""), HUGE_VAL}) {
      d.value(p) = bad;
      EXPECT_THAT(testing::usage_error([&] { validate(p); }), HasSubstr(std::string(d.name) + " is ")) << bad;
    }
    d.value(p) = 0;
    EXPECT_EQ(testing::usage_error([&] { validate(p); }).empty(), d.may_be_zero) << d.name;
  }
  RobotParameters p = robot_set("grip");
  p.mass = -5;
  EXPECT_EQ(testing::usage_error([&] { validate(p); }), "mass is -5 kg, expected a positive number");
  EXPECT_THAT(testing::usage_error([] { robot_set("gripp"); }), HasSubstr("gripp"));
  EXPECT_THAT(testing::usage_error([] { experiment("exp4"); }), HasSubstr("exp4"));
}

TEST(DynamicsRefuses, DrivesThatCannotBe) {
  const auto error_of = [](auto change, double step = 0.1) {
    DriveSetup setup = setup_of("grip", "exp1_steered");
    change(setup);
    return testing::usage_error([&] { simulate_drive(setup, step); });
  };
  EXPECT_EQ(error_of([](DriveSetup& s) { s.segments[0].until_s = 1; }), "");
  EXPECT_THAT(error_of([](DriveSetup& s) { s.segments.clear(); }), HasSubstr("segments: found none"));
  EXPECT_THAT(error_of([](DriveSetup& s) { s.segments[0].until_s = 0; }),
              HasSubstr("segment 1: until_s is 0, expected more than 0 (a duration above 0)"));
  EXPECT_THAT(error_of([](DriveSetup& s) {
                s.segments.push_back({20, {}, {}, false});
              }),
              HasSubstr("segment 2: until_s is 20, expected more than 50"));
  EXPECT_THAT(error_of([](DriveSetup& s) { s.segments[0].steering[2] = 1.6; }),
              HasSubstr("segment 1: the steering of wheel 3 is 91.6732 deg, expected -90 to 90"));
  EXPECT_THAT(error_of([](DriveSetup& s) { s.segments[0].voltage[0] = std::nan(""); }),
              HasSubstr("voltage of wheel 1"));
  EXPECT_THAT(error_of([](DriveSetup&) {}, 0), HasSubstr("output_step_s is 0"));
  EXPECT_THAT(error_of([](DriveSetup& s) { s.integration.step_s = -1; }), HasSubstr("step_s is -1"));
  EXPECT_THAT(error_of([](DriveSetup& s) { s.integration.relative_tolerance = 0; }),
              HasSubstr("relative_tolerance is 0"));
  EXPECT_THAT(error_of([](DriveSetup& s) {
                s.model = {false, true, true};
              }),
              HasSubstr("contradictory options"));
  EXPECT_THAT(testing::usage_error([] { SensorNoise{-1, 0, 0}.validate(); }), HasSubstr("encoder_m2 is -1"));
}

TEST(DynamicsRefuses, AStepTooLongForTheMotor) {
  DriveSetup setup = setup_of("grip", "exp1_steered");
  setup.integration.method = Method::RungeKutta4;
  setup.integration.step_s = 0.1;  // the current's time constant is 2.6 ms
  EXPECT_THROW(simulate_drive(setup, 0.5), std::runtime_error);
}

}  // namespace
}  // namespace odobench::dynamics
