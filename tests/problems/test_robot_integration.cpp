// Rules of integration and their derivatives.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "datasets/robots/layouts.hpp"
#include "problems/robots/integration.hpp"
#include "tests/support/data/robots.hpp"

namespace odobench::robots {
namespace {

using testing::differences;
using testing::flat;

const std::vector<IntegrationRule> kRules = {IntegrationRule::Euler, IntegrationRule::Midpoint,
                                             IntegrationRule::Arc, IntegrationRule::OptiodomOmni};

Matrix track(IntegrationRule rule, const Matrix& motions, const Eigen::Vector3d& start = {0.1, -0.2, 0.3}) {
  Matrix poses(3, motions.cols() + 1);
  integrate(rule, motions, start, poses, Vector::Ones(motions.cols()));
  return poses;
}

TEST(RobotIntegration, ArcIsACircle) {
  Matrix motions(3, 10);
  for (Eigen::Index k = 0; k < 10; ++k) motions.col(k) << 0.5, 0, 0.25;  // radius 2
  const Matrix poses = track(IntegrationRule::Arc, motions, {0, 0, 0});
  for (Eigen::Index k = 0; k <= 10; ++k) {
    const double theta = 0.25 * static_cast<double>(k);
    EXPECT_NEAR(poses(0, k), 2 * std::sin(theta), 1e-14);
    EXPECT_NEAR(poses(1, k), 2 * (1 - std::cos(theta)), 1e-14);
    EXPECT_NEAR(poses(2, k), theta, 1e-14);
  }
  EXPECT_GT((track(IntegrationRule::Midpoint, motions, {0, 0, 0}) - poses).norm(), 1e-3);
}

// Their formula: the chord (sin, 1 - cos) of the turn, which lies in the frame before it, turned by half the
// turn as well.
TEST(RobotIntegration, OptiodomTurnsByHalfTheAngleTwice) {
  const Eigen::Vector3d start(0.1, -0.2, 0.3);
  Matrix motions(3, 1);
  motions << 0.4, -0.1, 0.7;
  const double q = motions(2, 0), a = start[2] + q / 2;
  const Eigen::Vector2d chord((std::sin(q) * 0.4 - (1 - std::cos(q)) * -0.1) / q,
                              ((1 - std::cos(q)) * 0.4 + std::sin(q) * -0.1) / q);
  const Matrix poses = track(IntegrationRule::OptiodomOmni, motions, start);
  EXPECT_NEAR(poses(0, 1), start[0] + std::cos(a) * chord[0] - std::sin(a) * chord[1], 1e-15);
  EXPECT_NEAR(poses(1, 1), start[1] + std::sin(a) * chord[0] + std::cos(a) * chord[1], 1e-15);
}

TEST(RobotIntegration, OptiodomIsEulerBelowItsThreshold) {
  for (const double seconds : {1.0, 0.01}) {
    Matrix motions(3, 1), by_rule(3, 2);
    motions << 1, 0, 0.99e-5 * seconds;
    integrate(IntegrationRule::OptiodomOmni, motions, {0, 0, 0}, by_rule, Vector::Constant(1, seconds));
    EXPECT_EQ(by_rule(1, 1), 0);
    motions(2, 0) = 1.01e-5 * seconds;
    integrate(IntegrationRule::OptiodomOmni, motions, {0, 0, 0}, by_rule, Vector::Constant(1, seconds));
    EXPECT_GT(by_rule(1, 1), 0);
  }
}

TEST(RobotIntegration, QuotientAndItsDerivativeByLongArithmetic) {
  for (double h = 1e-20; h < 3; h *= 1.7)
    for (const double x : {h, -h}) {
      const long double l = x, f = std::sin(l) / l;
      EXPECT_NEAR(sine_quotient(x), static_cast<double>(f), 4e-16) << x;
      // (cos - f) / h in long double is good for 1e-19 / h; below that the first terms of the series.
      const long double d = h > 1e-3 ? (std::cos(l) - f) / l : -l / 3 + l * l * l / 30;
      EXPECT_NEAR(sine_quotient_derivative(x), static_cast<double>(d), 2e-15) << x;
    }
  EXPECT_EQ(sine_quotient(0), 1);
  EXPECT_EQ(sine_quotient_derivative(0), 0);
}

// Derivatives of poses by the parameters of a robot, of motions of every size of turn, also of none.
TEST(RobotIntegration, DerivativesAreThoseOfDifferences) {
  const WheeledRobot robot(make_robot(layout("differential")));
  std::mt19937 random(3);
  Matrix increments = testing::random_signals(robot, 30, random);
  for (Eigen::Index k = 0; k < 10; ++k) increments(1, k) = increments(0, k);    // equal wheels
  for (Eigen::Index k = 10; k < 20; ++k) increments(1, k) = -increments(0, k);  // on the spot
  const Vector z = robot.nominal();
  for (const IntegrationRule rule : kRules) {
    Matrix t(3, 30), j(90, 3), poses(3, 31), by(93, 3);
    robot.twists_and_jacobian(increments, z, t, j);
    integrate(rule, t, j, {0.1, -0.2, 0.3}, poses, by, Vector::Ones(30));
    EXPECT_EQ(poses, track(rule, t)) << name_of(rule);
    EXPECT_EQ(by.topRows(3).norm(), 0);
    // The threshold is a step of the poses: not across it.
    if (rule == IntegrationRule::OptiodomOmni) continue;
    const Matrix expected = differences(
        [&](const Vector& y) { return flat(track(rule, testing::twists_of(robot, increments, y))); }, z);
    EXPECT_LT((by - expected).cwiseAbs().maxCoeff(), 1e-8 * expected.cwiseAbs().maxCoeff()) << name_of(rule);
  }
}

TEST(RobotIntegration, DerivativesByTheMotionsThemselves) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  Matrix motions(3, 6);
  for (Eigen::Index i = 0; i < 18; ++i) motions(i % 3, i / 3) = unit(random);
  for (const IntegrationRule rule : kRules) {
    Matrix poses(3, 7), by(21, 18);
    integrate(rule, motions, Matrix::Identity(18, 18), {0.1, -0.2, 0.3}, poses, by, Vector::Ones(6));
    const Matrix expected =
        differences([&](const Vector& m) { return flat(track(rule, m.reshaped(3, 6))); }, flat(motions));
    EXPECT_LT((by - expected).cwiseAbs().maxCoeff(), 1e-9) << name_of(rule);
  }
}

// Where wheels turn equally, a step of 1e-19 rad must give the same derivative as 0 and as 1e-9.
TEST(RobotIntegration, DerivativeNearNoTurn) {
  Matrix by_zero;
  for (const double turn : {0.0, 1e-19, -1e-19, 1e-13, 1e-9}) {
    Matrix motions(3, 1), poses(3, 2), by(6, 3);
    motions << 0.3, 0.1, turn;
    integrate(IntegrationRule::Arc, motions, Matrix::Identity(3, 3), {0, 0, 0.5}, poses, by);
    if (turn == 0) by_zero = by;
    EXPECT_LT((by - by_zero).cwiseAbs().maxCoeff(), 1e-9) << turn;
    EXPECT_NEAR(by(3, 2), -(std::sin(0.5) * 0.3 + std::cos(0.5) * 0.1) / 2, 1e-9) << turn;
  }
}

TEST(RobotIntegration, Refusals) {
  EXPECT_EQ(integration_rule("optiodom-omni"), IntegrationRule::OptiodomOmni);
  for (const IntegrationRule rule : kRules) EXPECT_EQ(integration_rule(name_of(rule)), rule);
  try {
    integration_rule("midpiont");
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_THAT(e.what(), ::testing::HasSubstr("did you mean 'midpoint'?"));
  }
  Matrix motions = Matrix::Zero(3, 2), poses(3, 3), narrow(3, 2);
  EXPECT_THROW(integrate(IntegrationRule::Arc, motions, {0, 0, 0}, narrow), std::invalid_argument);
  EXPECT_THROW(integrate(IntegrationRule::OptiodomOmni, motions, {0, 0, 0}, poses), std::invalid_argument);
  EXPECT_THROW(integrate(IntegrationRule::OptiodomOmni, motions, {0, 0, 0}, poses, Vector::Zero(2)),
               std::invalid_argument);
  EXPECT_THROW(integrate(IntegrationRule::Arc, motions, {0, NAN, 0}, poses), std::invalid_argument);
  Matrix by(9, 2);
  EXPECT_THROW(integrate(IntegrationRule::Arc, motions, Matrix::Zero(6, 3), {0, 0, 0}, poses, by),
               std::invalid_argument);
  motions(1, 1) = HUGE_VAL;
  EXPECT_THROW(integrate(IntegrationRule::Arc, motions, {0, 0, 0}, poses), std::invalid_argument);
}

}  // namespace
}  // namespace odobench::robots
