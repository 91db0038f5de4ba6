// What holds for every class of wheeled robots, and its closed form: a new class is one layout and one row of
// kClasses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <array>
#include <cmath>
#include <map>
#include <ostream>

#include "base/angle.hpp"
#include "datasets/robots/layouts.hpp"
#include "tests/support/data/robots.hpp"

namespace odobench::robots {
namespace {

using testing::differences;
using testing::flat;
using testing::random_parameters;
using testing::random_signals;
using testing::twists_of;

// Values by name.
using Named = std::map<std::string, double>;

struct RobotClass {
  std::string layout;
  Dimensions dimensions;
  bool linear;
  bool holonomic;
  // How many combinations of free parameters no drive tells, with the tracked frame known, and with its mount
  // unknown, too.
  std::array<int, 2> hidden;
  // From parameters and signals; none where there is no closed form.
  std::function<Eigen::Vector3d(Named z, Named s)> closed_form;
  bool mean = false;        // by the published mean, which asymmetric robots do not invert
  bool fix_angles = false;  // zeros held at 0, so that the closed form or the linear form holds
};
void PrintTo(const RobotClass& c, std::ostream* out) {
  *out << c.layout << (c.fix_angles ? ", angles fixed" : "") << (c.mean ? ", mean" : "");
}

double wheel_path(const Named& z, const Named& s, int i) {
  return z.at("r" + std::to_string(i)) * s.at("wheel." + std::to_string(i));
}

Eigen::Vector3d differential_twist(const Named& z, const Named& s, double track) {
  const double right = z.at("r_right") * s.at("wheel.right"), left = z.at("r_left") * s.at("wheel.left");
  return {(right + left) / 2, 0, (right - left) / track};
}

Eigen::Vector3d bicycle_twist(const Named& z, const Named& s) {
  const double v = z.at("r") * (s.at("wheel.right") + s.at("wheel.left")) / 2;
  return {v, 0, v * std::tan(z.at("gain") * s.at("steering") + z.at("steering_zero")) / z.at("wheelbase")};
}

Eigen::Vector3d omni4_twist(const Named& z, const Named& s) {  // of rows [-sin a, cos a, R]
  Eigen::Vector3d t(0, 0, 0);
  for (int i = 1; i <= 4; ++i) {
    const double a = kPi / 4 * (2 * i - 1), u = wheel_path(z, s, i);
    t += Eigen::Vector3d(-std::sin(a) * u / 2, std::cos(a) * u / 2, u / (4 * z.at("R")));
  }
  return t;
}

// By rows with any roller angle: for 45 degrees (u1 + u2 + u3 + u4) / 4 and so on.
Eigen::Vector3d mecanum_twist(const Named& z, const Named& s) {
  const double u1 = wheel_path(z, s, 1), u2 = wheel_path(z, s, 2), u3 = wheel_path(z, s, 3),
               u4 = wheel_path(z, s, 4);
  const double g = std::tan(z.at("roller"));
  return {(u1 + u2 + u3 + u4) / 4, (-u1 + u2 + u3 - u4) / (4 * g),
          (-u1 + u2 - u3 + u4) / (4 * (z.at("ly") + z.at("lx") * g))};
}

// (2.16)-(2.17)
Eigen::Vector3d thesis_twist(const Named& z, const Named& s) {
  Eigen::Vector3d t(0, 0, 0);
  for (int i = 1; i <= 4; ++i) {
    const double a = z.at("a" + std::to_string(i)), b = z.at("b" + std::to_string(i));
    const double d = s.at("steering." + std::to_string(i)), v = wheel_path(z, s, i);
    t += Eigen::Vector3d(std::cos(d) / 4 * v, std::sin(d) / 4 * v,
                         (-b * std::cos(d) + a * std::sin(d)) / (4 * (a * a + b * b)) * v);
  }
  return t;
}

const std::vector<RobotClass> kClasses = {
    {"differential",
     {{"r_left", 0.055}},
     true,
     false,
     {0, 0},
     [](Named z, Named s) { return differential_twist(z, s, z.at("b")); }},
    {"skid_steer",
     {{"b", 0.4}},
     true,
     false,
     {0, 0},
     [](Named z, Named s) { return differential_twist(z, s, 0.4 * z.at("slip")); }},
    {"tricycle",
     {},
     true,
     false,
     {0, 0},
     [](Named z, Named s) {
       const double v = z.at("r") * s.at("wheel"), phi = s.at("steering") + z.at("steering_zero");
       return Eigen::Vector3d(v * std::cos(phi), 0, v * std::sin(phi) / z.at("wheelbase"));
     }},
    {"bicycle", {}, false, false, {0, 0}, bicycle_twist},
    {"bicycle", {}, true, false, {0, 0}, bicycle_twist, false, true},
    {"ackermann", {{"b_front", 0.5}}, false, false, {0, 0}, {}},
    {"omni3",
     {},
     true,
     true,
     {0, 0},
     [](Named z, Named s) {
       const double u1 = wheel_path(z, s, 1), u2 = wheel_path(z, s, 2), u3 = wheel_path(z, s, 3);
       return Eigen::Vector3d((u2 - u1) / std::sqrt(3), (2 * u3 - u1 - u2) / 3,
                              -(u1 + u2 + u3) / (3 * z.at("R")));
     }},
    {"omni3_full", {{"R2", 0.25}}, true, true, {0, 3}, {}},
    {"omni4", {}, true, true, {0, 0}, omni4_twist},
    {"omni4_full", {{"mount3", 0.05}}, true, true, {0, 3}, {}},
    {"mecanum", {{"lx", 0.3}}, true, true, {1, 1}, mecanum_twist},
    {"swerve", {{"modules", 3}, {"x1", 0.2}}, true, true, {0, 3}, {}},
    {"swerve", {{"modules", 5}}, true, true, {0, 3}, {}},
    {"swerve", {{"y4", -0.3}}, true, true, {0, 1}, {}, true},
    {"swerve_offset", {{"modules", 3}, {"offset2", 0.01}}, false, true, {0, 3}, {}},
    {"swerve_offset", {{"modules", 4}}, false, true, {0, 1}, {}, true},
    {"4wis4wid", {}, true, true, {0, 0}, thesis_twist, true},
};

WheelTable table_of(const RobotClass& c) {
  WheelTable t = make_robot(layout(c.layout), c.dimensions);
  if (c.mean) t.rule = TwistRule::Mean;
  if (c.fix_angles)
    for (BoundParameter& p : t.parameters)
      if (p.parameter.unit != "m") p.parameter.lower = p.parameter.upper = p.parameter.nominal;
  return t;
}

class RobotClasses : public ::testing::TestWithParam<RobotClass> {
 protected:
  static constexpr Eigen::Index kSamples = 40;
  const WheelTable table_ = table_of(GetParam());
  const WheeledRobot robot_{table_};
  std::mt19937 random_{7};
  const Matrix signals_ = random_signals(robot_, kSamples, random_);
  const Vector z_ = random_parameters(robot_, random_);

  // Twists that the robot can do.
  Eigen::Vector3d random_twist() {
    std::uniform_real_distribution<double> unit(-1, 1);
    return {unit(random_), GetParam().holonomic ? unit(random_) : 0, unit(random_)};
  }
  // A table with the same parameters, twists at the same z.
  void expect_same(const WheelTable& other, const Matrix& signals, const Matrix& expected) const {
    const WheeledRobot robot(other);
    ASSERT_EQ(robot.signals(), robot_.signals());
    EXPECT_LT((twists_of(robot, signals, z_) - expected).cwiseAbs().maxCoeff(), 1e-13);
  }
};

// Of those classes that have one; of those that are steered and not by the mean.
class RobotClosedForms : public RobotClasses {};
class RobotSteeringRates : public RobotClasses {};

std::vector<RobotClass> classes_where(const std::function<bool(const RobotClass&)>& holds) {
  std::vector<RobotClass> classes;
  std::copy_if(kClasses.begin(), kClasses.end(), std::back_inserter(classes), holds);
  return classes;
}
std::string name_of_row(const ::testing::TestParamInfo<RobotClass>& row) {
  return std::to_string(row.index) + "_" + row.param.layout + (row.param.mean ? "_mean" : "") +
         (row.param.fix_angles ? "_fixed" : "");
}
bool is_steered(const RobotClass& c) {
  const WheelTable t = table_of(c);
  return std::any_of(t.wheels.begin(), t.wheels.end(), [](const Wheel& w) { return !w.steering.empty(); });
}
INSTANTIATE_TEST_SUITE_P(All, RobotClasses, ::testing::ValuesIn(kClasses), name_of_row);
INSTANTIATE_TEST_SUITE_P(All, RobotClosedForms, ::testing::ValuesIn(classes_where([](const RobotClass& c) {
                           return c.closed_form != nullptr;
                         })),
                         name_of_row);
INSTANTIATE_TEST_SUITE_P(All, RobotSteeringRates, ::testing::ValuesIn(classes_where([](const RobotClass& c) {
                           return !c.mean && is_steered(c);
                         })),
                         name_of_row);

TEST_P(RobotClasses, JacobianIsThatOfDifferences) {
  Matrix t(3, kSamples), j(3 * kSamples, z_.size());
  robot_.twists_and_jacobian(signals_, z_, t, j);
  EXPECT_EQ(t, twists_of(robot_, signals_, z_));
  const Matrix expected =
      differences([this](const Vector& z) { return flat(twists_of(robot_, signals_, z)); }, z_);
  EXPECT_LT((j - expected).cwiseAbs().maxCoeff(), 1e-8 * std::max(1.0, expected.cwiseAbs().maxCoeff()));
  EXPECT_GT(expected.cwiseAbs().colwise().maxCoeff().minCoeff(), 1e-4) << "a parameter without effect";
}

TEST_P(RobotSteeringRates, Jacobian) {
  const Matrix rates = Matrix::Random(signals_.rows() - robot_.drive_count(), kSamples);
  WheelTable table = table_;  // with trails, so that the rate enters each row
  for (Wheel& w : table.wheels)
    if (!w.steering.empty()) w.trail = 0.02;
  const WheeledRobot robot(table);
  Matrix t(3, kSamples), j(3 * kSamples, z_.size());
  robot.twists_and_jacobian(signals_, z_, t, j, &rates);
  const Matrix expected =
      differences([&](const Vector& z) { return flat(twists_of(robot, signals_, z, &rates)); }, z_);
  EXPECT_LT((j - expected).cwiseAbs().maxCoeff(), 1e-8 * std::max(1.0, expected.cwiseAbs().maxCoeff()));
  EXPECT_GT((t - twists_of(robot, signals_, z_)).norm(), 1e-3) << "the rate changes nothing";
}

TEST_P(RobotClosedForms, AgreesWithTheRows) {
  const Matrix t = twists_of(robot_, signals_, z_);
  Named z, s;
  for (std::size_t i = 0; i < robot_.parameters().size(); ++i)
    z[robot_.parameters()[i].name] = z_[static_cast<Eigen::Index>(i)];
  for (Eigen::Index k = 0; k < kSamples; ++k) {
    for (std::size_t i = 0; i < robot_.signals().size(); ++i)
      s[robot_.signals()[i]] = signals_(static_cast<Eigen::Index>(i), k);
    const Eigen::Vector3d expected = GetParam().closed_form(z, s);
    EXPECT_LT((t.col(k) - expected).norm(), 1e-13 * std::max(1.0, expected.norm())) << t.col(k) << "\n"
                                                                                    << expected;
  }
}

TEST_P(RobotClasses, ForwardOfInverse) {
  WheelTable table = table_;
  table.rule = TwistRule::LeastSquares;
  const WheeledRobot robot(table);
  for (int k = 0; k < 50; ++k) {
    const Eigen::Vector3d u = random_twist();
    const Matrix signals = robot.inverse(u, z_);
    EXPECT_LT((twists_of(robot, signals, z_) - u).norm(), 1e-12);
    EXPECT_LT(robot.residual_norms(signals, z_)[0], 1e-12) << "slip without slipping";
    for (Eigen::Index i = robot.drive_count(); i < signals.rows(); ++i)
      EXPECT_LE(std::abs(signals(i, 0)), kPi / 2 + 0.25);
  }
}

TEST_P(RobotClasses, InverseRefusesWhatTheRobotCannotDo) {
  if (GetParam().holonomic) {
    EXPECT_NO_THROW(robot_.inverse({0.1, 0.2, 0.3}, z_));
    return;
  }
  EXPECT_NO_THROW(robot_.inverse({0.1, 0, 0.3}, z_));
  EXPECT_THROW(robot_.inverse({0.1, 1e-6, 0.3}, z_), std::invalid_argument);
}

TEST_P(RobotClasses, StandstillHoldsTheSteering) {
  const Vector held = signals_.col(0);
  const Vector signals = robot_.inverse({0, 0, 0}, z_, held);
  EXPECT_EQ(signals.head(robot_.drive_count()).norm(), 0);
  const Eigen::Index steered = held.size() - robot_.drive_count();
  EXPECT_EQ(signals.tail(steered), held.tail(steered));
}

// y -> -y, with all angles the other way round, is the mirrored robot: it moves with (vx, -vy, -omega).
TEST_P(RobotClasses, MirrorSymmetry) {
  WheelTable mirrored = table_;
  const auto flips = [](WheelField f) {
    return f == WheelField::Y || f == WheelField::Mount || f == WheelField::Roller || f == WheelField::Zero ||
           f == WheelField::Offset;
  };
  for (Wheel& w : mirrored.wheels)
    for (double* value : {&w.y, &w.mount, &w.roller, &w.zero, &w.offset}) *value = -*value;
  for (BoundParameter& p : mirrored.parameters)
    for (Binding& b : p.bindings)
      if (flips(b.field)) b.factor = -b.factor;
  Matrix signals = signals_;
  signals.bottomRows(signals.rows() - robot_.drive_count()) *= -1;
  Matrix expected = twists_of(robot_, signals_, z_);
  expected.bottomRows(2) *= -1;
  expect_same(mirrored, signals, expected);
}

TEST_P(RobotClasses, MatrixTimesStreams) {
  ASSERT_EQ(robot_.is_linear(), GetParam().linear);
  if (!robot_.is_linear()) {
    EXPECT_THROW(robot_.matrix(z_), std::logic_error);
    EXPECT_THROW(robot_.streams(signals_), std::logic_error);
    return;
  }
  const Matrix s = robot_.streams(signals_);
  ASSERT_EQ(s.rows(), robot_.stream_count());
  Matrix t(3, kSamples), j(3 * kSamples, z_.size()), m;
  std::vector<Matrix> dm;
  robot_.twists_and_jacobian(signals_, z_, t, j);
  EXPECT_LT((robot_.matrix(z_) * s - t).cwiseAbs().maxCoeff(),
            1e-13 * std::max(1.0, t.cwiseAbs().maxCoeff()));
  robot_.matrix_and_derivatives(z_, m, dm);
  EXPECT_EQ(m, robot_.matrix(z_));
  ASSERT_EQ(dm.size(), robot_.parameters().size());
  for (std::size_t i = 0; i < dm.size(); ++i) {
    const RobotParameter& p = robot_.parameters()[i];
    const Vector by =
        p.lower == p.upper ? Vector(Vector::Zero(3 * kSamples)) : Vector(j.col(static_cast<Eigen::Index>(i)));
    EXPECT_LT((flat(dm[i] * s) - by).cwiseAbs().maxCoeff(), 1e-12 * std::max(1.0, by.cwiseAbs().maxCoeff()))
        << p.name;
  }
}

// Rank of the derivatives of many twists, in units of the box. A mount (l_x, l_y, l_th) of the tracked frame
// changes a twist by (0, omega, 0), (-omega, 0, 0) and (vy, -vx, 0).
TEST_P(RobotClasses, WhatNoDriveTells) {
  constexpr Eigen::Index kMany = 200;
  const Matrix signals = random_signals(robot_, kMany, random_);
  const Eigen::Index n = z_.size();
  Matrix t(3, kMany), j = Matrix::Zero(3 * kMany, n + 3);
  robot_.twists_and_jacobian(signals, z_, t, j.leftCols(n));
  for (Eigen::Index k = 0; k < kMany; ++k) {
    j(3 * k, n + 1) = -t(2, k);
    j(3 * k + 1, n) = t(2, k);
    j(3 * k, n + 2) = t(1, k);
    j(3 * k + 1, n + 2) = -t(0, k);
  }
  int held = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const RobotParameter& p = robot_.parameters()[static_cast<std::size_t>(i)];
    j.col(i) *= (p.upper - p.lower) / 2;
    held += p.lower == p.upper;
  }
  const auto hidden = [&](const Matrix& m) {
    const Vector values = Eigen::JacobiSVD<Matrix>(m).singularValues();
    return (values.array() < 1e-10 * values[0]).count() - held;
  };
  EXPECT_EQ(hidden(j.leftCols(n)), GetParam().hidden[0]);
  EXPECT_EQ(hidden(j), GetParam().hidden[1]);
}

TEST_P(RobotClasses, ListingEveryWheelTwiceChangesNoTwist) {
  WheelTable twice = table_;
  twice.wheels.insert(twice.wheels.end(), table_.wheels.begin(), table_.wheels.end());
  for (BoundParameter& p : twice.parameters) {
    const std::vector<Binding> once = p.bindings;
    for (Binding b : once) {
      b.wheel += table_.wheels.size();
      p.bindings.push_back(b);
    }
  }
  expect_same(twice, signals_, twists_of(robot_, signals_, z_));
  const Eigen::Vector3d u = random_twist();
  EXPECT_LT((WheeledRobot(twice).inverse(u, z_) - robot_.inverse(u, z_)).norm(), 1e-9);
}

TEST_P(RobotClasses, WheelTurnedByPiWithNegativeRadiusIsTheSame) {
  WheelTable turned = table_;
  for (Wheel& w : turned.wheels) {
    w.mount += kPi;
    for (double* value : {&w.radius, &w.offset, &w.trail}) *value = -*value;
  }
  for (BoundParameter& p : turned.parameters)
    for (Binding& b : p.bindings)
      if (b.field == WheelField::Radius || b.field == WheelField::Offset || b.field == WheelField::Trail)
        b.factor = -b.factor;
  expect_same(turned, signals_, twists_of(robot_, signals_, z_));
}

TEST_P(RobotClasses, MeanEqualsLeastSquaresWhereItSaysSo) {
  const bool all_steered = std::all_of(table_.wheels.begin(), table_.wheels.end(), [](const Wheel& w) {
    return !w.steering.empty() && !w.drive.empty();
  });
  if (!all_steered) {
    EXPECT_FALSE(robot_.mean_equals_least_squares(z_));
    return;
  }
  WheelTable mean = table_, least = table_;
  mean.rule = TwistRule::Mean;
  least.rule = TwistRule::LeastSquares;
  const auto apart = [&](const Vector& z) {
    return (twists_of(WheeledRobot(mean), signals_, z) - twists_of(WheeledRobot(least), signals_, z)).norm();
  };
  EXPECT_FALSE(robot_.mean_equals_least_squares(z_));
  EXPECT_GT(apart(z_), 1e-6);
  const Vector z = WheeledRobot(make_robot(layout(GetParam().layout),
                                           GetParam().dimensions.contains("modules")
                                               ? Dimensions{{"modules", GetParam().dimensions.at("modules")}}
                                               : Dimensions{}))
                       .nominal();
  EXPECT_TRUE(robot_.mean_equals_least_squares(z));
  EXPECT_LT(apart(z), 1e-13);
}

// Every class has its rows here.
TEST(RobotLayouts, EachIsTested) {
  std::vector<std::string> tested, known;
  for (const RobotClass& c : kClasses) tested.push_back(c.layout);
  for (const Layout& l : layouts()) {
    known.push_back(l.name);
    EXPECT_FALSE(l.description.empty());
    EXPECT_FALSE(l.blind.empty()) << l.name;
    EXPECT_FALSE(dimensions(l).empty()) << l.name;
    EXPECT_EQ(l.rule, l.name == "4wis4wid" ? IntegrationRule::Euler : IntegrationRule::Arc);
  }
  for (const std::string& name : known) EXPECT_THAT(tested, ::testing::Contains(name));
}

}  // namespace
}  // namespace odobench::robots
