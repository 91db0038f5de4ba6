// Tables of wheels: what is refused, and single properties that the suite over all classes does not show.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>

#include "base/error.hpp"
#include "datasets/robot_4wis4wid.hpp"
#include "datasets/robots/layouts.hpp"
#include "problems/robots/four_wheel_steering.hpp"
#include "tests/support/data/robots.hpp"

namespace odobench::robots {
namespace {

using ::testing::HasSubstr;
using testing::twists_of;

template <class Error>
std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << "nothing was refused";
  return "";
}

struct Refusal {
  std::string name;
  std::function<void(WheelTable&)> damage;
  std::string message;
};

TEST(RobotTables, RefusedInOneLine) {
  const std::vector<Refusal> refusals = {
      {"no wheels",
       [](WheelTable& t) {
         t.wheels.clear();
         t.parameters.clear();
       },
       "no wheels"},
      {"nan", [](WheelTable& t) { t.wheels[1].x = NAN; }, "wheel 2: x is not finite"},
      {"weight", [](WheelTable& t) { t.wheels[0].drive[0].weight = 0; },
       "weight 0 of drive signal 'wheel.right'"},
      {"twice",
       [](WheelTable& t) {
         t.wheels[0].drive.push_back({"wheel.right", 1});
       },
       "'wheel.right' is listed twice"},
      {"unnamed", [](WheelTable& t) { t.wheels[0].drive[0].name = ""; }, "without a name"},
      {"zero", [](WheelTable& t) { t.wheels[0].zero = 0.1; }, "wheel 1: a steering zero"},
      {"unit", [](WheelTable& t) { t.parameters[0].parameter.unit = "mm"; },
       "unit 'mm', expected 'm', 'rad' or 'ratio'"},
      {"box", [](WheelTable& t) { t.parameters[0].parameter.lower = 1; },
       "expected lower <= nominal <= upper"},
      {"names", [](WheelTable& t) { t.parameters[2].parameter.name = "b"; }, "parameter 'b' is listed twice"},
      {"unbound", [](WheelTable& t) { t.parameters[2].bindings.clear(); }, "'r_left' is bound to nothing"},
      {"wheel 3", [](WheelTable& t) { t.parameters[2].bindings[0].wheel = 2; }, "bound to wheel 3 of 2"},
      {"factor", [](WheelTable& t) { t.parameters[2].bindings[0].factor = 0; },
       "factor 0 on radius of wheel 2"},
      {"bound twice",
       [](WheelTable& t) {
         t.parameters[2].bindings.push_back({1, WheelField::Radius, 2});
       },
       "is bound twice to radius of wheel 2"},
      {"no steering", [](WheelTable& t) { t.parameters[2].bindings[0].field = WheelField::Zero; },
       "'r_left' is bound to zero of wheel 2, which is not steered"},
      {"no drive", [](WheelTable& t) { t.wheels[1].drive.clear(); },
       "bound to radius of wheel 2, which has no drive signal"},
      {"radius", [](WheelTable& t) { t.parameters.pop_back(); }, "wheel 2 is driven, but its radius is 0"},
      {"kinds", [](WheelTable& t) { t.wheels[1].steering = "wheel.right"; },
       "wheel 2 is steered by 'wheel.right', which drives"},
      {"rows", [](WheelTable& t) { t.wheels[0].slides = t.wheels[1].slides = true; },
       "2 wheels state 2 equations"},
      {"mean", [](WheelTable& t) { t.rule = TwistRule::Mean; }, "wheel 1 is not"},
      {"rank", [](WheelTable& t) { t.parameters.erase(t.parameters.begin()); },
       "wheel 1 drive, wheel 1 side, wheel 2 drive, wheel 2 side"},
  };
  for (const Refusal& r : refusals) {
    WheelTable table = make_robot(layout("differential"));
    r.damage(table);
    const std::string said = message_of<std::invalid_argument>([&] { WheeledRobot{table}; });
    EXPECT_THAT(said, HasSubstr(r.message)) << r.name;
    EXPECT_THAT(said, ::testing::Not(HasSubstr("\n"))) << r.name;
  }
}

TEST(RobotTables, CallsRefused) {
  const WheeledRobot robot(make_robot(layout("swerve")));
  const Vector z = robot.nominal();
  const Matrix signals = Matrix::Ones(8, 2);
  Matrix t(3, 2), narrow(3, 1);
  const auto said = [&](const std::function<void()>& call) {
    return message_of<std::invalid_argument>(call);
  };
  EXPECT_THAT(said([&] { robot.twists(Matrix::Ones(7, 2), z, t); }),
              HasSubstr("signals are 7 x 2, expected 8 x 2"));
  EXPECT_THAT(said([&] { robot.twists(signals, z, narrow); }), HasSubstr("twists are 3 x 1, expected 3 x 2"));
  EXPECT_THAT(said([&] { robot.twists(signals, z.head(3), t); }), HasSubstr("3 parameters, expected 20"));
  Matrix j(6, 3);
  EXPECT_THAT(said([&] { robot.twists_and_jacobian(signals, z, t, j); }), HasSubstr("expected 6 x 20"));
  Matrix broken = signals;
  broken(5, 1) = NAN;
  EXPECT_THAT(said([&] { robot.twists(broken, z, t); }), HasSubstr("'steering.2' is not finite at sample 1"));
  Vector far = z;
  far[7] = HUGE_VAL;
  EXPECT_THAT(said([&] { robot.twists(signals, far, t); }), HasSubstr("'r2' is not finite"));
  const Matrix rates = Matrix::Ones(3, 2);
  EXPECT_THAT(said([&] { robot.twists(signals, z, t, &rates); }),
              HasSubstr("steering rates are 3 x 2, expected 4 x 2"));
  Vector moved = z;
  moved[4] = 0.01;
  EXPECT_NO_THROW(robot.twists(signals, moved, t));
  EXPECT_THAT(said([&] { robot.matrix(moved); }), HasSubstr("'offset1' is held fixed at 0, found 0.01"));
  EXPECT_THAT(said([&] {
                robot.inverse({1, 0, 0}, z, Vector::Zero(3));
              }),
              HasSubstr("3 signals held, expected 8"));
  const WheeledRobot mean(make_robot(layout("4wis4wid")));
  const Matrix four = Matrix::Ones(4, 2);
  EXPECT_THAT(said([&] { mean.twists(signals, mean.nominal(), t, &four); }), HasSubstr("no steering rates"));
  const WheeledRobot mecanum(make_robot(layout("mecanum")));
  Vector flat = mecanum.nominal();
  flat[2] = 1.6;
  EXPECT_THAT(said([&] { mecanum.twists(Matrix::Ones(4, 2), flat, t); }), HasSubstr("roller angle"));
}

// A steered passive wheel whose axle points at the driven one tells nothing new: the robot may turn about
// that one.
TEST(RobotTables, RankAtASample) {
  WheelTable table;
  table.wheels.resize(2);
  table.wheels[0].x = 1;
  table.wheels[0].radius = 0.1;
  table.wheels[0].drive = {{"wheel", 1}};
  table.wheels[1].steering = "steering";
  const WheeledRobot robot(table);
  Matrix signals(2, 3), t(3, 3);
  signals << 1, 1, 1, 0.3, 1.2, 0;
  EXPECT_NO_THROW(robot.twists(signals, Vector(), t));
  signals(1, 1) = std::acos(-1.0) / 2;
  const std::string said = message_of<DataError>([&] { robot.twists(signals, Vector(), t); });
  EXPECT_THAT(said, HasSubstr("sample 1: the wheels do not tell the twist"));
  EXPECT_THAT(said, HasSubstr("of the rows wheel 1 drive, wheel 1 side, wheel 2 side"));
  // The limit is a millionth, to either side.
  signals(1, 1) = std::acos(-1.0) / 2 + 1e-7;
  EXPECT_THROW(robot.twists(signals, Vector(), t), DataError);
  signals(1, 1) = std::acos(-1.0) / 2 + 1e-5;
  EXPECT_NO_THROW(robot.twists(signals, Vector(), t));
  // Units of length do not matter.
  table.wheels[0].x = 1e6;
  signals(1, 1) = 1;
  EXPECT_NO_THROW(WheeledRobot(table).twists(signals, Vector(), t));
}

TEST(RobotTables, SwappedWheelsWithNegativeTrackAreTheSame) {
  const WheeledRobot robot(make_robot(layout("differential")));
  std::mt19937 random(1);
  const Matrix signals = testing::random_signals(robot, 5, random);
  const Matrix swapped = signals.colwise().reverse();
  const Vector z = Eigen::Vector3d(0.3, 0.05, 0.06), z_swapped = Eigen::Vector3d(-0.3, 0.06, 0.05);
  EXPECT_LT((twists_of(robot, signals, z) - twists_of(robot, swapped, z_swapped)).norm(), 1e-15);
}

// "omni4" of OptiOdom (J. Intell. Robot. Syst. 105:39): full distances L1, L2, wheels 2 and 4 count
// backwards.
TEST(RobotTables, OptiodomOmni4IsMecanumWithTwoSignalsReversed) {
  const WheeledRobot plain(make_robot(layout("mecanum")));
  WheelTable table = plain.table();
  table.wheels[1].drive[0].weight = table.wheels[3].drive[0].weight = -1;
  const WheeledRobot robot(table);
  std::mt19937 random(1);
  const Matrix signals = testing::random_signals(robot, 5, random);
  Vector z = testing::random_parameters(robot, random);
  z[2] = std::acos(-1.0) / 4;
  Matrix reversed = signals;
  reversed.row(1) *= -1;
  reversed.row(3) *= -1;
  const Matrix t = twists_of(robot, signals, z);
  EXPECT_EQ(t, twists_of(plain, reversed, z));
  for (Eigen::Index k = 0; k < 5; ++k) {
    const Vector u = signals.col(k).cwiseProduct(z.tail(4));
    const double lengths = 2 * z[0] + 2 * z[1];
    EXPECT_NEAR(t(0, k), (u[0] - u[1] + u[2] - u[3]) / 4, 1e-14);
    EXPECT_NEAR(t(1, k), (-u[0] - u[1] + u[2] + u[3]) / 4, 1e-14);
    EXPECT_NEAR(t(2, k), -(u[0] + u[1] + u[2] + u[3]) / (2 * lengths), 1e-14);
  }
}

// Origin beside the middle of the axle: vy = -o_x omega.
TEST(RobotTables, OriginOffTheAxle) {
  WheelTable table = make_robot(layout("differential"));
  for (Wheel& w : table.wheels) w.x -= 0.07;
  const WheeledRobot robot(table);
  const Matrix t = twists_of(robot, Eigen::Vector2d(2, -1), robot.nominal());
  EXPECT_NEAR(t(2, 0), 0.05 * 3 / 0.3, 1e-15);
  EXPECT_NEAR(t(1, 0), -0.07 * -1 * t(2, 0), 1e-15);
}

// A castor that is locked states its side only; a free one states nothing.
TEST(RobotTables, Castors) {
  WheelTable table = make_robot(layout("differential"));
  Wheel castor;
  castor.x = 0.2;
  castor.slides = true;
  table.wheels.push_back(castor);
  const WheeledRobot free_castor(table);
  const Matrix signals = Eigen::Vector2d(2, 1);
  const Matrix expected =
      twists_of(WheeledRobot(make_robot(layout("differential"))), signals, free_castor.nominal());
  EXPECT_EQ(twists_of(free_castor, signals, free_castor.nominal()), expected);
  table.wheels[2].slides = false;
  const WheeledRobot locked(table);
  EXPECT_GT((twists_of(locked, signals, locked.nominal()) - expected).norm(), 1e-3);
  EXPECT_GT(locked.residual_norms(signals, locked.nominal())[0], 1e-3);
  EXPECT_THAT(message_of<std::invalid_argument>([&] {
                locked.inverse({0.1, 0, 0.5}, locked.nominal());
              }),
              HasSubstr("wheel 3 would have to move sideways by 0.1 m/s"));
}

// A wheel that follows behind its pivot points where its contact goes.
TEST(RobotTables, InverseWithTrailAndOffset) {
  WheelTable table = make_robot(layout("swerve_offset"), {{"offset1", 0.01}, {"offset2", -0.02}});
  for (Wheel& w : table.wheels) w.trail = -0.03;
  const WheeledRobot robot(table);
  const Vector z = robot.nominal();
  for (const Eigen::Vector3d& u : {Eigen::Vector3d(0.5, 0.1, 0.4), Eigen::Vector3d(-0.3, 0.2, -1)}) {
    const Matrix signals = robot.inverse(u, z);
    EXPECT_LT((twists_of(robot, signals, z) - u).norm(), 1e-13);
    EXPECT_LT(robot.residual_norms(signals, z)[0], 1e-13);
  }
  EXPECT_THAT(message_of<std::invalid_argument>([&] {
                robot.inverse({0.2, -0.2, 1}, z);
              }),
              HasSubstr("wheel 1 cannot roll"));
}

TEST(RobotTables, SharedSignals) {
  WheelTable table = make_robot(layout("differential"));
  table.wheels[1].drive = table.wheels[0].drive;
  const WheeledRobot robot(table);
  EXPECT_NEAR(robot.inverse({0.1, 0, 0}, robot.nominal())[0], 2, 1e-12);
  EXPECT_THAT(message_of<std::invalid_argument>([&] {
                robot.inverse({0.1, 0, 0.1}, robot.nominal());
              }),
              HasSubstr("share a drive signal"));
}

TEST(RobotLayouts, DimensionsAndSingleParameters) {
  const WheeledRobot robot(make_robot(layout("omni3_full"), {{"R", 0.3}, {"R2", 0.25}}));
  EXPECT_EQ(robot.nominal().head(3), Eigen::Vector3d(0.3, 0.25, 0.3));
  EXPECT_NEAR(robot.parameters()[1].lower, 0.25 * 0.85, 1e-15);
  EXPECT_NEAR(robot.parameters()[1].upper, 0.25 * 1.15, 1e-15);
  const auto said = [](const std::string& name, const Dimensions& d) {
    return message_of<std::invalid_argument>([&] { make_robot(layout(name), d); });
  };
  EXPECT_THAT(said("tricycle", {{"whelbase", 1}}),
              HasSubstr("tricycle has no dimension 'whelbase', did you mean 'wheelbase'?"));
  EXPECT_THAT(said("tricycle", {{"r", 0}}), HasSubstr("dimension 'r' is 0, expected more than 0"));
  EXPECT_THAT(said("tricycle", {{"r", NAN}}), HasSubstr("dimension 'r' is not finite"));
  EXPECT_THAT(said("swerve", {{"modules", 2.5}}), HasSubstr("whole number from 2 to 32"));
  EXPECT_THAT(said("swerve", {{"x9", 1}}), HasSubstr("no dimension 'x9'"));
  EXPECT_THAT(message_of<std::invalid_argument>([] { layout("mecanumm"); }),
              HasSubstr("did you mean 'mecanum'?"));
  EXPECT_EQ(WheeledRobot(make_robot(layout("swerve"), {{"modules", 32}})).parameters().size(), 160u);
}

// The thesis' robot has the parameters and bounds of its set.
TEST(RobotLayouts, FourWheelSteeringIsThatOfTheThesis) {
  const WheeledRobot robot(make_robot(layout("4wis4wid")));
  const Robot expected = robot_4wis4wid();
  ASSERT_EQ(robot.parameters().size(), expected.parameters.size());
  for (std::size_t i = 0; i < expected.parameters.size(); ++i) {
    const RobotParameter &p = robot.parameters()[i], &e = expected.parameters[i];
    EXPECT_EQ(p.name, e.name);
    EXPECT_EQ(p.unit, e.unit);
    EXPECT_EQ(p.nominal, e.nominal);
    EXPECT_EQ(p.lower, e.lower);
    EXPECT_EQ(p.upper, e.upper);
  }
  EXPECT_TRUE(robot.mean_equals_least_squares(robot.nominal()));
}

// The equations that calibration, fusion and simulation share are those of the table of wheels, turned by the
// heading.
TEST(RobotLayouts, PublishedVelocityIsThatOfTheWheels) {
  WheelTable table =
      make_robot(layout("swerve_offset"), {{"x1", 0.15}, {"offset1", 0.01}, {"offset3", -0.02}});
  table.rule = TwistRule::Mean;
  const WheeledRobot robot(table);
  std::mt19937 random(1);
  const Matrix signals = testing::random_signals(robot, 20, random);
  const Vector z = robot.nominal();
  const Matrix twists = twists_of(robot, signals, z);
  for (Eigen::Index k = 0; k < 20; ++k) {
    const double heading = 0.3 * static_cast<double>(k);
    const PublishedVelocity v = published_velocity(heading, [&](std::size_t i) {
      const auto w = static_cast<Eigen::Index>(i), p = 5 * w;  // x, y, r, zero, offset
      return SteeredWheel{z[p], z[p + 1], z[p + 2] * signals(w, k), signals(4 + w, k), z[p + 4]};
    });
    const Eigen::Vector2d world = Eigen::Rotation2Dd(heading) * twists.col(k).head<2>();
    EXPECT_NEAR(v.vx, world[0], 1e-15);
    EXPECT_NEAR(v.vy, world[1], 1e-15);
    EXPECT_NEAR(v.omega, twists(2, k), 1e-14);
  }
}

}  // namespace
}  // namespace odobench::robots
