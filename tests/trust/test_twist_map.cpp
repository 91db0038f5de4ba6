// What drives determine: the map from commands to twists of every class of robots.
#include "problems/trust/twist_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"
#include "datasets/robots/layouts.hpp"
#include "problems/information/combinations.hpp"
#include "problems/robots/wheeled_robot.hpp"

namespace odobench {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

Robot robot_of(const std::string& name, const robots::Dimensions& dimensions = {}) {
  const robots::Layout& layout = robots::layout(name);
  Robot robot;
  robot.name = robot.kinematics = layout.name;
  robot.table = robots::make_robot(layout, dimensions);
  for (const BoundParameter& p : robot.table.parameters) robot.parameters.push_back(p.parameter);
  return robot;
}

// Somewhere in the box, `spread` of its half width away from the middle.
Vector point_of(const std::vector<ParameterInfo>& parameters, Random& random, double spread = 0.8) {
  Vector z(static_cast<Eigen::Index>(parameters.size()));
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const ParameterInfo& p = parameters[static_cast<std::size_t>(i)];
    z[i] = (p.lower + p.upper) / 2 + spread * (random.uniform() - 0.5) * (p.upper - p.lower);
  }
  return z;
}

std::vector<std::string> names_of(const TwistMap& map) {
  std::vector<std::string> names;
  for (const TwistNumber& n : map.numbers) names.push_back(n.name);
  return names;
}
const TwistNumber& number(const TwistMap& map, const std::string& name) {
  for (const TwistNumber& n : map.numbers)
    if (n.name == name) return n;
  throw std::out_of_range(name);
}

class TwistMapOf : public ::testing::TestWithParam<std::string> {};

TEST_P(TwistMapOf, IsOneAndNoughtAtNominalValues) {
  const Robot robot = robot_of(GetParam());
  const robots::WheeledRobot wheeled(robot.table);
  const TwistMap map = twist_map(robot, robot.parameters, wheeled.nominal());
  ASSERT_FALSE(map.numbers.empty());
  for (const TwistNumber& n : map.numbers) {
    const bool factor = n.entry == TwistEntry::Path || n.entry == TwistEntry::Turn;
    EXPECT_NEAR(n.nominal, factor ? 1 : 0, 1e-12) << n.name;
    EXPECT_NEAR(n.value, n.nominal, 1e-12) << n.name;
    EXPECT_FALSE(n.words.empty());
    EXPECT_EQ(n.unit.empty(), factor) << n.name;
  }
}

TEST_P(TwistMapOf, IsTheTwistOfCommandsWithItsGradient) {
  const Robot robot = robot_of(GetParam());
  Random random(7);
  for (int draw = 0; draw < 5; ++draw) {
    const Vector z = point_of(robot.parameters, random);
    const TwistMap map = twist_map(robot, robot.parameters, z);
    const Vector scale = relative_scales(robot.parameters);
    for (const TwistNumber& n : map.numbers) {
      EXPECT_GT(n.gradient.cwiseProduct(scale).norm(), 0) << n.name;
      for (Eigen::Index i = 0; i < z.size(); ++i) {
        if (scale[i] == 0) continue;
        const double step = 1e-5 * scale[i];
        Vector up = z, down = z;
        up[i] += step;
        down[i] -= step;
        const double slope = (number(twist_map(robot, robot.parameters, up), n.name).value -
                              number(twist_map(robot, robot.parameters, down), n.name).value) /
                             (2 * step);
        EXPECT_NEAR(n.gradient[i] * scale[i], slope * scale[i], 1e-7) << n.name << " by " << i;
      }
    }
  }
}

// Every number again from the robot itself, and for commands in between.
TEST_P(TwistMapOf, HoldsForCommandsInBetween) {
  const Robot robot = robot_of(GetParam());
  const robots::WheeledRobot wheeled(robot.table);
  Random random(11);
  const Vector z = point_of(robot.parameters, random);
  const TwistMap map = twist_map(robot, robot.parameters, z);
  const Matrix m = twist_matrix(robot, robot.parameters, z);
  for (const TwistNumber& n : map.numbers) {
    if (n.name[0] != 'm') continue;  // of an arc
    EXPECT_NEAR(n.value, m(n.name[1] - '1', n.name[2] - '1'), 1e-12) << n.name;
  }
  if (!map.linear || !m.allFinite()) return;
  for (int draw = 0; draw < 50; ++draw) {
    const Eigen::Vector3d command(random.normal(1), random.normal(1), random.normal(1));
    Matrix twist(3, 1);
    wheeled.twists(wheeled.inverse(command, wheeled.nominal()), z, twist);
    EXPECT_LT((twist - m * command).norm(), 1e-12 * (1 + command.norm()));
  }
}

std::vector<std::string> all_classes() {
  std::vector<std::string> names;
  for (const robots::Layout& l : robots::layouts()) names.push_back(l.name);
  return names;
}
INSTANTIATE_TEST_SUITE_P(Robots, TwistMapOf, ::testing::ValuesIn(all_classes()),
                         [](const auto& p) { return (p.param[0] == '4' ? "r" : "") + p.param; });

TEST(TwistMap, SixNumbersOfThePublishedMean) {
  const Robot robot = robot_of("4wis4wid");
  const robots::WheeledRobot wheeled(robot.table);
  const Vector nominal = wheeled.nominal();
  Random random(3);
  for (int draw = 0; draw < 200; ++draw) {
    const Vector z = point_of(robot.parameters, random, 2);
    const Eigen::Array4d a = z.segment<4>(0), b = z.segment<4>(4), a0 = nominal.segment<4>(0),
                         b0 = nominal.segment<4>(4);
    const Eigen::Array4d rho = z.segment<4>(8).array() / nominal.segment<4>(8).array(), s = a * a + b * b;
    Eigen::Matrix3d m;
    m << rho.sum() / 4, 0, -(rho * b0).sum() / 4, 0, rho.sum() / 4, (rho * a0).sum() / 4,
        -(rho * b / s).sum() / 4, (rho * a / s).sum() / 4, (rho * (a * a0 + b * b0) / s).sum() / 4;
    const TwistMap map = twist_map(robot, robot.parameters, z);
    EXPECT_THAT(names_of(map), ElementsAre("m11", "m31", "m32", "m13", "m23", "m33"));
    EXPECT_TRUE(map.linear);
    for (const TwistNumber& n : map.numbers)
      EXPECT_NEAR(n.value, m(n.name[1] - '1', n.name[2] - '1'), 1e-12) << n.name;
    // (2.16)-(2.17) as written.
    const Eigen::Vector3d command(random.normal(1), random.normal(1), random.normal(1));
    const Vector signals = wheeled.inverse(command, nominal);
    Eigen::Vector3d twist = Eigen::Vector3d::Zero();
    for (Eigen::Index i = 0; i < 4; ++i) {
      const double v = z[8 + i] * signals[i], d = signals[4 + i];
      twist += v / 4 *
               Eigen::Vector3d(std::cos(d), std::sin(d), (-b[i] * std::cos(d) + a[i] * std::sin(d)) / s[i]);
    }
    EXPECT_LT((m * command - twist).norm(), 1e-12 * (1 + command.norm()));
  }
}

TEST(TwistMap, FourNumbersOfTwoWheels) {
  const Robot robot = robot_of("differential", {{"b", 0.3}, {"r", 0.05}});
  const Vector z = Eigen::Vector3d(0.31, 0.052, 0.049);  // b, r_right, r_left
  const TwistMap map = twist_map(robot, robot.parameters, z);
  EXPECT_THAT(names_of(map), ElementsAre("m11", "m31", "m13", "m33"));
  EXPECT_NEAR(number(map, "m11").value, (0.052 + 0.049) / 2 / 0.05, 1e-14);
  EXPECT_NEAR(number(map, "m31").value, (0.052 - 0.049) / 0.31 / 0.05, 1e-14);
  EXPECT_NEAR(number(map, "m13").value, (0.052 - 0.049) / 2 * 0.15 / 0.05, 1e-14);
  EXPECT_NEAR(number(map, "m33").value, (0.052 + 0.049) / 0.31 * 0.15 / 0.05, 1e-14);
  EXPECT_THAT(map.remarks, ::testing::Contains(HasSubstr("cannot be driven sideways")));
  EXPECT_EQ(words_with(number(map, "m11"), 0.0005), "path along x +1.000 +- 0.050 %");
  EXPECT_EQ(words_with(number(map, "m33"), std::nan("")), "turn -2.26 %");
}

TEST(TwistMap, ArcsOfRobotsThatSteer) {
  for (const char* name : {"tricycle", "bicycle", "ackermann"}) {
    const Robot robot = robot_of(name);
    Vector z = robots::WheeledRobot(robot.table).nominal();
    const TwistMap map = twist_map(robot, robot.parameters, z);
    EXPECT_THAT(names_of(map), ::testing::IsSupersetOf({"m11", "m31", "left_turn", "right_turn"})) << name;
    EXPECT_THAT(map.remarks, ::testing::Contains(HasSubstr("Arcs are of"))) << name;
  }
  // A bicycle with a shorter wheelbase turns more on both arcs, and straight on as before.
  const Robot bicycle = robot_of("bicycle");
  Vector z = robots::WheeledRobot(bicycle.table).nominal();
  z[0] *= 0.9;
  const TwistMap map = twist_map(bicycle, bicycle.parameters, z);
  EXPECT_NEAR(number(map, "left_turn").value, 1 / 0.9, 1e-12);
  EXPECT_NEAR(number(map, "right_turn").value, 1 / 0.9, 1e-12);
  EXPECT_NEAR(number(map, "m31").value, 0, 1e-12);
}

TEST(TwistMap, LeavesOutWhatNothingMovesAndIgnoresForeignParameters) {
  Robot robot = robot_of("mecanum");
  std::vector<ParameterInfo> parameters = robot.parameters;
  parameters.insert(parameters.begin(), {"time_offset", "s", 0, -0.1, 0.1});
  Vector z(8);
  z << 0.05, robots::WheeledRobot(robot.table).nominal();
  const TwistMap map = twist_map(robot, parameters, z);
  for (const TwistNumber& n : map.numbers) {
    ASSERT_EQ(n.gradient.size(), 8);
    EXPECT_EQ(n.gradient[0], 0);
  }
  // All radii and the roller angle held: only lx, ly move anything, and only turns.
  for (std::size_t i = 3; i < parameters.size(); ++i)
    parameters[i].lower = parameters[i].upper = parameters[i].nominal;
  const TwistMap held = twist_map(robot, parameters, z);
  EXPECT_THAT(names_of(held), ElementsAre("m33"));
  EXPECT_THAT(held.remarks, ::testing::Contains(HasSubstr("No free parameter moves: path factor along x")));
}

}  // namespace
}  // namespace odobench
