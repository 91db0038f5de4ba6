// The calibration problem of any wheeled robot: against the structured form, differences, and sets made by
// the robot itself.
#include <gtest/gtest.h>

#include <cmath>

#include "base/angle.hpp"
#include "datasets/robot_4wis4wid.hpp"
#include "datasets/robots/robot.hpp"
#include "problems/calibration/calibration_problem.hpp"
#include "solvers/solve.hpp"
#include "tests/support/data/synthetic_recording.hpp"

namespace odobench {
namespace {

using robots::IntegrationRule;
using testing::synthetic_recording;

Vector vector_of(const std::vector<ParameterInfo>& parameters) {
  Vector z(static_cast<Eigen::Index>(parameters.size()));
  for (Eigen::Index i = 0; i < z.size(); ++i) z[i] = parameters[static_cast<std::size_t>(i)].nominal;
  return z;
}

// Inside the box, at a place of its own for each variant.
Vector inside(const std::vector<ParameterInfo>& parameters, int variant) {
  Vector z = vector_of(parameters);
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const ParameterInfo& p = parameters[static_cast<std::size_t>(i)];
    z[i] += 0.4 * (p.upper - p.lower) * std::sin(1.0 + 2.3 * static_cast<double>(i) + variant);
  }
  return z;
}

// Signals of a drive of `samples` stamps, each with a rhythm of its own.
Recording made_up_drive(const Robot& robot, int samples, SignalKind drive_kind) {
  const robots::WheeledRobot model(robot.table);
  Recording r;
  r.id = "made_up";
  r.trajectory = "made_up";
  r.repetition = 1;
  Eigen::Index row = 0;
  for (const std::string& name : model.signals()) {
    const bool drives = row++ < model.drive_count();
    Signal signal{name, drives ? drive_kind : SignalKind::Angle, {}};
    const double scale = !drives ? 0.3 : drive_kind == SignalKind::Increment ? 0.2 : 4.0;
    for (int k = 0; k < samples; ++k)
      signal.values.push_back(scale * std::sin(0.05 * k + 0.7 * static_cast<double>(row)) +
                              (drives ? scale * 0.8 : 0.0));
    r.signals.push_back(std::move(signal));
  }
  for (int k = 0; k < samples; ++k) r.time_us.push_back(50'000 * k + 1'000 * (k % 3));
  r.reference = {{},
                 std::vector<double>(r.size(), 0.0),
                 std::vector<double>(r.size(), 0.0),
                 std::vector<double>(r.size(), 0.0)};
  return r;
}

// The drive as the robot with parameters z makes it, seen from `mount`.
Recording driven(const Robot& robot, Recording r, const Vector& z, const CalibrationOptions& options) {
  const CalibrationProblem problem(robot, {r}, options);
  const PoseTrack q = problem.integrate(0, z);
  r.reference = {{}, q.x, q.y, q.theta};
  return r;
}

struct Case {
  const char* kinematics;
  SignalKind kind;
};
std::ostream& operator<<(std::ostream& out, const Case& c) {
  return out << c.kinematics << " " << name_of(c.kind);
}

class AnyRobot : public ::testing::TestWithParam<Case> {
 protected:
  Robot robot_ = robot_of_class(GetParam().kinematics, {});
  // Three drives that differ from those of the nominal robot.
  std::vector<Recording> recordings(const CalibrationOptions& options, const Vector& z) const {
    std::vector<Recording> list;
    for (const int samples : {60, 3, 41})
      list.push_back(driven(robot_, made_up_drive(robot_, samples, GetParam().kind), z, options));
    return list;
  }
};

TEST_P(AnyRobot, JacobianGradientAndNormalEquationsAgreeWithDifferences) {
  for (const CostKind cost :
       {CostKind::EverySample, CostKind::FinalPose, CostKind::Segments, CostKind::Optiodom})
    for (const IntegrationRule rule :
         {IntegrationRule::Euler, IntegrationRule::Midpoint, IntegrationRule::Arc})
      for (const bool mount : {false, true}) {
        CalibrationOptions options;
        options.cost = cost;
        options.rule = rule;
        options.mount = mount;
        options.position_weight = 2;
        options.heading_weight = 0.3;
        options.distance = 0.05;
        const CalibrationProblem empty(robot_, {made_up_drive(robot_, 4, GetParam().kind)}, options);
        const CalibrationProblem problem(robot_, recordings(options, inside(empty.parameters(), 3)), options);
        const Vector z = inside(problem.parameters(), 1);
        const Eigen::Index m = problem.residual_count(), n = z.size();
        Vector r(m), up(m), down(m);
        Matrix j(m, n);
        problem.residuals_and_jacobian(z, r, j);
        EXPECT_NEAR(problem.cost(z), r.squaredNorm(), 1e-12 * r.squaredNorm());
        for (Eigen::Index p = 0; p < n; ++p) {
          Vector a = z, b = z;
          const double h = 1e-6;
          a[p] += h;
          b[p] -= h;
          problem.residuals(a, up);
          problem.residuals(b, down);
          const double worst = ((up - down) / (2 * h) - j.col(p)).cwiseAbs().maxCoeff();
          EXPECT_LT(worst, 2e-7 * std::max(1.0, j.cwiseAbs().maxCoeff()))
              << options.text() << " " << problem.parameters()[static_cast<std::size_t>(p)].name;
        }
        NormalEquations e;
        problem.normal_equations(z, e);
        EXPECT_NEAR(e.cost, r.squaredNorm(), 1e-12 * e.cost);
        EXPECT_LT((e.jtr - j.transpose() * r).norm(), 1e-11 * (1 + e.jtr.norm()));
        EXPECT_LT((e.jtj - j.transpose() * j).norm(), 1e-11 * (1 + e.jtj.norm()));
      }
}

TEST_P(AnyRobot, TheTruthHasNoCostByAnyCost) {
  for (const CostKind cost :
       {CostKind::EverySample, CostKind::FinalPose, CostKind::Segments, CostKind::Optiodom})
    for (const bool mount : {false, true}) {
      CalibrationOptions options;
      options.cost = cost;
      options.rule = IntegrationRule::Arc;
      options.mount = mount;
      options.distance = 0.05;
      const CalibrationProblem empty(robot_, {made_up_drive(robot_, 4, GetParam().kind)}, options);
      const Vector truth = inside(empty.parameters(), 3);
      const CalibrationProblem problem(robot_, recordings(options, truth), options);
      EXPECT_LT(problem.cost(truth), 1e-24) << options.text();
      EXPECT_GT(problem.cost(inside(problem.parameters(), 1)), 1e-8) << options.text();
      // The order of the runs does not matter.
      std::vector<Recording> reversed = problem.recordings();
      std::reverse(reversed.begin(), reversed.end());
      const CalibrationProblem other(robot_, reversed, options);
      const Vector z = inside(problem.parameters(), 1);
      EXPECT_NEAR(problem.cost(z) / other.cost(z), 1, 1e-13);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Every, AnyRobot,
    ::testing::Values(Case{"differential", SignalKind::Increment}, Case{"differential", SignalKind::Speed},
                      Case{"tricycle", SignalKind::Increment}, Case{"bicycle", SignalKind::Speed},
                      Case{"ackermann", SignalKind::Speed}, Case{"omni3", SignalKind::Increment},
                      Case{"omni4_full", SignalKind::Speed}, Case{"mecanum", SignalKind::Speed},
                      Case{"swerve_offset", SignalKind::Speed}, Case{"4wis4wid", SignalKind::Speed}),
    [](const auto& c) {
      return (std::isdigit(c.param.kinematics[0]) ? "r" : "") + std::string(c.param.kinematics) + "_" +
             name_of(c.param.kind);
    });

TEST(WheeledCalibration, TheThesisRobotByTheGeneralPathAgreesWithTheStructuredForm) {
  const std::vector<Recording> recordings{synthetic_recording(900, 0.02, 1),
                                          synthetic_recording(33, 0.05, 2)};
  const Robot robot = robot_4wis4wid();
  CalibrationOptions options;
  options.from_origin = true;
  const CalibrationProblem structured(robot, recordings, options);
  ASSERT_TRUE(structured.structured());
  const WheeledForm general(robots::WheeledRobot(robot.table), recordings, options);
  for (int variant = 0; variant < 4; ++variant) {
    const Vector z = inside(structured.parameters(), variant);
    EXPECT_NEAR(general.cost(z) / structured.cost(z), 1, 1e-10);
    NormalEquations a, b;
    general.normal_equations(z, a);
    structured.normal_equations(z, b);
    EXPECT_LT((a.jtr - b.jtr).norm(), 1e-10 * b.jtr.norm());
    EXPECT_LT((a.jtj - b.jtj).norm(), 1e-10 * b.jtj.norm());
    Vector r(structured.residual_count()), r_general(r.size());
    Matrix j(r.size(), 12), j_general(r.size(), 12);
    structured.residuals_and_jacobian(z, r, j);
    general.residuals_and_jacobian(z, r_general, j_general);
    EXPECT_LT((r - r_general).norm(), 1e-10 * r.norm());
    EXPECT_LT((j - j_general).norm(), 1e-10 * j.norm());
  }
}

// The fast form's against the general form's Jacobian.
void expect_normal_equations(const CalibrationProblem& problem, const Vector& z, const std::string& what) {
  Vector r(problem.residual_count());
  Matrix j(r.size(), z.size());
  problem.residuals_and_jacobian(z, r, j);
  NormalEquations e;
  problem.normal_equations(z, e);
  EXPECT_EQ(e.cost, problem.cost(z)) << what;
  EXPECT_NEAR(e.cost / r.squaredNorm(), 1, 1e-11) << what;
  const Vector norms = j.colwise().norm().cwiseMax(1e-300);
  const Vector jtr = j.transpose() * r;
  EXPECT_LT((e.jtr - jtr).cwiseQuotient(norms).cwiseAbs().maxCoeff(), 1e-10 * r.norm()) << what;
  const Matrix difference = e.jtj - j.transpose() * j;
  EXPECT_LT(difference.cwiseQuotient(norms * norms.transpose()).cwiseAbs().maxCoeff(), 1e-10) << what;
}

TEST(WheeledCalibration, EveryKernelAgreesWithTheGeneralForm) {
  // Several blocks and segments, tails, and drives shorter than a register is wide.
  for (const std::string kinematics : {"differential", "omni3", "mecanum", "swerve"}) {
    const Robot robot = robot_of_class(kinematics, {});
    std::vector<Recording> recordings;
    for (const int samples : {4'611, 2, 7, 260, 2'048})
      recordings.push_back(made_up_drive(robot, samples, SignalKind::Increment));
    for (const IntegrationRule rule :
         {IntegrationRule::Euler, IntegrationRule::Midpoint, IntegrationRule::Arc}) {
      CalibrationOptions options;
      options.rule = rule;
      options.position_weight = 3;
      options.heading_weight = 0.5;
      for (const InstructionSet kernel : available_instruction_sets()) {
        const CalibrationProblem problem(robot, recordings, options, kernel);
        ASSERT_FALSE(problem.structured());
        for (int variant = 0; variant < 3; ++variant) {
          const Vector z = inside(problem.parameters(), variant);
          Vector r(problem.residual_count());
          problem.residuals(z, r);
          EXPECT_NEAR(problem.cost(z) / r.squaredNorm(), 1, 1e-11)
              << kinematics << " " << options.text() << " " << to_string(kernel);
          expect_normal_equations(problem, z, kinematics + " " + to_string(kernel));
        }
      }
    }
  }
}

// The kernels take eight steps at a time.
TEST(WheeledCalibration, NormalEquationsAtTheEndsOfBlocks) {
  for (const std::string kinematics : {"differential", "omni4_full", "4wis4wid"}) {
    const Robot robot = robot_of_class(kinematics, {});
    for (const InstructionSet kernel : available_instruction_sets())
      for (const int steps : {1, 7, 8, 9, 15, 16, 17}) {
        const int width = kernel::select(kernel).width;
        CalibrationOptions options;
        options.rule = IntegrationRule::Arc;
        const std::vector<Recording> recordings{
            made_up_drive(robot, width * steps + 2, SignalKind::Increment),
            made_up_drive(robot, width * steps + 1, SignalKind::Increment)};
        const CalibrationProblem problem(robot, recordings, options, kernel);
        expect_normal_equations(problem, inside(problem.parameters(), 1),
                                kinematics + " " + std::to_string(steps));
      }
  }
}

TEST(WheeledCalibration, StepsThatTurnFarAreLeftToTheGeneralForm) {
  const Robot robot = robot_of_class("differential", {});
  Recording r = made_up_drive(robot, 60, SignalKind::Increment);
  for (double& value : r.signals[0].values) value *= 10;  // up to 0.6 rad a step
  CalibrationOptions options;
  options.rule = IntegrationRule::Arc;
  const CalibrationProblem problem(robot, {r}, options);
  const Vector z = inside(problem.parameters(), 1);
  Vector residuals(problem.residual_count());
  problem.residuals(z, residuals);
  EXPECT_NEAR(problem.cost(z) / residuals.squaredNorm(), 1, 1e-13);
  expect_normal_equations(problem, z, "far");
}

TEST(WheeledCalibration, ExactDataHaveNoCostToAllDigits) {
  const Robot robot = robot_of_class("mecanum", {});
  CalibrationOptions options;
  options.rule = IntegrationRule::Arc;
  Recording r = made_up_drive(robot, 3'000, SignalKind::Increment);
  const Vector truth = inside(CalibrationProblem(robot, {r}, options).parameters(), 2);
  r = driven(robot, r, truth, options);
  const CalibrationProblem problem(robot, {r}, options);
  EXPECT_LT(problem.cost(truth), problem.rounding_floor(truth));
  EXPECT_GE(problem.cost(truth), 0);
}

TEST(WheeledCalibration, TheFirstIncrementIsNeverUsed) {
  const Robot robot = robot_of_class("differential", {});
  Recording r = made_up_drive(robot, 30, SignalKind::Increment);
  CalibrationOptions options;
  options.rule = IntegrationRule::Arc;
  const Vector z = inside(CalibrationProblem(robot, {r}, options).parameters(), 1);
  const double before = CalibrationProblem(robot, {r}, options).cost(z);
  for (Signal& signal : r.signals) signal.values[0] = 1e9;
  EXPECT_EQ(CalibrationProblem(robot, {r}, options).cost(z), before);
}

TEST(WheeledCalibration, ATapeMeasureAtTheEndIsEnough) {
  // Heading in (-pi, pi], place at the end only, after several turns.
  const Robot robot = robot_of_class("differential", {});
  CalibrationOptions options;
  options.rule = IntegrationRule::Arc;
  Vector truth(3);
  truth << 0.31, 0.0493, 0.0505;
  std::vector<Recording> recordings;
  for (const double turn : {1.0, -1.0, 0.3}) {
    Recording r = made_up_drive(robot, 400, SignalKind::Increment);
    for (double& value : r.signals[1].values) value *= turn;
    r = driven(robot, r, truth, options);
    const std::size_t last = r.size() - 1;
    r.reference = {
        {last}, {r.reference.x[last]}, {r.reference.y[last]}, {wrapped_angle(r.reference.theta[last])}};
    recordings.push_back(std::move(r));
  }
  const CalibrationProblem every(robot, recordings, options);
  EXPECT_EQ(every.residual_count(), 9);
  EXPECT_LT(every.cost(truth), 1e-22);
  options.cost = CostKind::FinalPose;
  const auto final_pose = std::make_shared<const CalibrationProblem>(robot, recordings, options);
  const Vector z = inside(every.parameters(), 1);
  EXPECT_EQ(every.cost(z), final_pose->cost(z)) << "the same rows";
  const Result result = solve(Problem(final_pose), parse_solver_list("lm").front(), truth * 1.01, {});
  EXPECT_LT((result.x - truth).norm(), 1e-8);
}

TEST(WheeledCalibration, NamesWhatARecordingLacks) {
  const Robot robot = robot_of_class("tricycle", {});
  CalibrationOptions options;
  const auto refusal = [&](const std::function<void(Recording&)>& spoil) -> std::string {
    Recording r = made_up_drive(robot, 10, SignalKind::Speed);
    spoil(r);
    try {
      const CalibrationProblem problem(robot, {r}, options);
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(refusal([](Recording&) {}), "");
  EXPECT_EQ(refusal([](Recording& r) { r.signals.pop_back(); }),
            "recording 'made_up' has no signal 'steering', which the robot needs");
  EXPECT_EQ(refusal([](Recording& r) { r.signals[0].kind = SignalKind::Angle; }),
            "recording 'made_up': signal 'wheel' is an angle, expected a speed or an increment");
  EXPECT_EQ(refusal([](Recording& r) { r.signals[1].kind = SignalKind::Speed; }),
            "recording 'made_up': signal 'steering' is a speed, expected an angle");
  EXPECT_EQ(refusal([](Recording& r) {
              r.reference = {{0}, {0}, {0}, {0}};
            }),
            "recording 'made_up' has no reference after its start");
}

TEST(WheeledCalibration, NumbersThatAreNotFiniteGiveNoCost) {
  const Robot robot = robot_of_class("swerve_offset", {});
  CalibrationOptions options;
  const CalibrationProblem problem(robot, {made_up_drive(robot, 20, SignalKind::Speed)}, options);
  Vector z = vector_of(problem.parameters());
  z[2] = std::nan("");
  EXPECT_TRUE(std::isnan(problem.cost(z)));
  z[2] = 1e308;
  EXPECT_FALSE(std::isfinite(problem.cost(z)));
}

}  // namespace
}  // namespace odobench
