// Twists, rows, derivatives and poses of ten robots against an independent evaluation.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "datasets/robots/layouts.hpp"
#include "problems/robots/integration.hpp"
#include "tests/support/data/robots.hpp"
#include "tests/support/shared_data.hpp"

namespace odobench::robots {
namespace {

using nlohmann::json;

const json& reference() {
  static const json document = [] {
    std::ifstream file(testing::shared_folder() / "reference" / "robots_synthetic.json");
    return json::parse(file);
  }();
  return document;
}

struct Named {
  std::string key, layout;
  Dimensions dimensions;
};
// Swerve modules at the points have offsets, in the recordings none.
std::string at_points(const Named& named) {
  return named.layout == "swerve" ? "swerve_offset" : named.layout;
}
const std::vector<Named> kRobots = {
    {"differential", "differential", {}},
    {"tricycle", "tricycle", {}},
    {"ackermann", "ackermann", {}},
    {"omni3", "omni3_full", {}},
    {"omni4", "omni4_full", {}},
    {"mecanum4", "mecanum", {}},
    {"swerve3", "swerve", {{"modules", 3}}},
    {"swerve4", "swerve", {{"modules", 4}}},
};

Matrix matrix_of(const json& rows) {
  const auto lists = rows.get<std::vector<std::vector<double>>>();
  Matrix m(static_cast<Eigen::Index>(lists.size()), static_cast<Eigen::Index>(lists.at(0).size()));
  for (Eigen::Index i = 0; i < m.rows(); ++i)
    m.row(i) = Eigen::Map<const Eigen::RowVectorXd>(lists[static_cast<std::size_t>(i)].data(), m.cols());
  return m;
}
Vector vector_of(const json& list) {
  const auto values = list.get<std::vector<double>>();
  return Eigen::Map<const Vector>(values.data(), static_cast<Eigen::Index>(values.size()));
}

// Largest |value - expected| / max(1, |expected|).
double apart(const Matrix& value, const Matrix& expected) {
  if (value.rows() != expected.rows() || value.cols() != expected.cols()) return HUGE_VAL;
  return ((value - expected).array().abs() / expected.array().abs().max(1)).maxCoeff();
}

Vector parameters_of(const WheeledRobot& robot, const json& z) {
  Vector values = robot.nominal();
  std::size_t used = 0;
  for (std::size_t i = 0; i < robot.parameters().size(); ++i)
    if (z.contains(robot.parameters()[i].name)) {
      values[static_cast<Eigen::Index>(i)] = z.at(robot.parameters()[i].name).get<double>();
      ++used;
    }
  EXPECT_EQ(used, z.size()) << "a parameter that the layout does not have";
  return values;
}

// One column per sample; a single number is one sample. "wheel.mean" is both wheels of the bicycle.
Matrix signals_of(const WheeledRobot& robot, const std::vector<json>& maps) {
  std::vector<Vector> rows;
  for (const std::string& name : robot.signals())
    for (const json& map : maps) {
      const std::string key = map.contains("wheel.mean") && name.starts_with("wheel.") ? "wheel.mean" : name;
      if (!map.contains(key)) continue;
      rows.push_back(map.at(key).is_number() ? Vector(Vector::Constant(1, map.at(key).get<double>()))
                                             : vector_of(map.at(key)));
    }
  EXPECT_EQ(rows.size(), robot.signals().size());
  Matrix m(static_cast<Eigen::Index>(rows.size()), rows.at(0).size());
  for (Eigen::Index i = 0; i < m.rows(); ++i) m.row(i) = rows[static_cast<std::size_t>(i)];
  return m;
}

// The layout gives the wheels that the reference has.
void check_wheels(const WheelTable& table, const Vector& z, const json& wheels, const std::string& what) {
  ASSERT_EQ(table.wheels.size(), wheels.size()) << what;
  for (std::size_t i = 0; i < wheels.size(); ++i) {
    Wheel w = table.wheels[i];
    for (std::size_t p = 0; p < table.parameters.size(); ++p)
      for (const Binding& b : table.parameters[p].bindings)
        if (b.wheel == i) field_of(w, b.field) += b.factor * z[static_cast<Eigen::Index>(p)];
    for (std::size_t f = 0; f < kWheelFieldNames.size(); ++f) {
      if (kWheelFieldNames[f] == "gain") continue;
      EXPECT_NEAR(w.*kWheelFieldMembers[f], wheels[i].at(kWheelFieldNames[f]).get<double>(), 1e-15)
          << what << " wheel " << i + 1 << " " << kWheelFieldNames[f];
    }
    EXPECT_EQ(w.steering, wheels[i].at("steering").get<std::string>()) << what;
    EXPECT_EQ(w.drive.empty() ? "" : w.drive[0].name, wheels[i].at("drive").get<std::string>()) << what;
    EXPECT_EQ(w.slides, wheels[i].at("slides").get<bool>()) << what;
  }
}

// Columns in the order of the reference.
Matrix selected(const Matrix& jacobian, const WheeledRobot& robot, const json& names) {
  Matrix m(jacobian.rows(), static_cast<Eigen::Index>(names.size()));
  for (std::size_t k = 0; k < names.size(); ++k)
    for (std::size_t i = 0; i < robot.parameters().size(); ++i)
      if (robot.parameters()[i].name == names[k].get<std::string>())
        m.col(static_cast<Eigen::Index>(k)) = jacobian.col(static_cast<Eigen::Index>(i));
  return m;
}

void check_twist(const WheeledRobot& robot, const json& point, const std::string& twist,
                 const std::string& jacobian, const std::string& what) {
  const Vector z = parameters_of(robot, point.at("z"));
  const Matrix signals = signals_of(robot, {point.at("signals")});
  Matrix t(3, 1), j(3, z.size());
  robot.twists_and_jacobian(signals, z, t, j);
  EXPECT_LT(apart(t, vector_of(point.at(twist))), 1e-12) << what;
  EXPECT_LT(apart(selected(j, robot, point.at("parameters")), matrix_of(point.at(jacobian))), 1e-12) << what;
  if (!robot.is_linear()) return;
  EXPECT_LT(apart(robot.matrix(z) * robot.streams(signals), vector_of(point.at(twist))), 1e-12) << what;
}

TEST(RobotsReference, PointsWithSlip) {
  ODOBENCH_NEEDS_SHARED();
  for (const Named& named : kRobots) {
    const json& entry = reference().at(named.key);
    WheelTable table = make_robot(layout(at_points(named)), named.dimensions);
    const WheeledRobot robot(table);
    check_wheels(table, parameters_of(robot, entry.at("z")), entry.at("wheels"), named.key);
    ASSERT_EQ(entry.at("points").size(), 6u);
    for (const json& point : entry.at("points")) {
      check_twist(robot, point, "twist", "jacobian", named.key);
      const Vector z = parameters_of(robot, point.at("z"));
      const Matrix signals = signals_of(robot, {point.at("signals")});
      const WheelRows rows = robot.rows(signals, z);
      EXPECT_LT(apart(rows.a, matrix_of(point.at("rows_A"))), 1e-12) << named.key;
      EXPECT_LT(apart(rows.b, vector_of(point.at("rows_b"))), 1e-12) << named.key;
      EXPECT_NEAR(robot.residual_norms(signals, z)[0], point.at("residual_norm").get<double>(), 1e-12)
          << named.key;
    }
  }
}

TEST(RobotsReference, PublishedMean) {
  ODOBENCH_NEEDS_SHARED();
  int seen = 0;
  for (const Named& named : kRobots) {
    WheelTable table = make_robot(layout(at_points(named)), named.dimensions);
    table.rule = TwistRule::Mean;
    for (const json& point : reference().at(named.key).at("points")) {
      if (!point.contains("twist_mean")) continue;
      check_twist(WheeledRobot(table), point, "twist_mean", "jacobian_mean", named.key);
      ++seen;
    }
  }
  EXPECT_GE(seen, 6);
}

TEST(RobotsReference, Bicycle) {
  ODOBENCH_NEEDS_SHARED();
  const WheeledRobot robot(make_robot(layout("bicycle")));
  ASSERT_EQ(reference().at("bicycle").at("points").size(), 6u);
  for (const json& point : reference().at("bicycle").at("points"))
    check_twist(robot, point, "twist", "jacobian", "bicycle");
}

TEST(RobotsReference, SteeringRates) {
  ODOBENCH_NEEDS_SHARED();
  for (const json& point : reference().at("steering_rate").at("points")) {
    const std::size_t modules = point.at("wheels").size();
    const WheeledRobot robot(
        make_robot(layout("swerve_offset"), {{"modules", static_cast<double>(modules)}}));
    const Vector z = parameters_of(robot, point.at("z"));
    const Matrix signals = signals_of(robot, {point.at("signals")});
    Matrix rates(static_cast<Eigen::Index>(modules), 1);
    for (std::size_t i = 0; i < modules; ++i)
      rates(static_cast<Eigen::Index>(i), 0) =
          point.at("steering_rate").at("steering." + std::to_string(i + 1)).get<double>();
    check_wheels(robot.table(), z, point.at("wheels"), "steering_rate");
    EXPECT_LT(apart(testing::twists_of(robot, signals, z, &rates), vector_of(point.at("twist_with_rate"))),
              1e-12);
    EXPECT_LT(apart(testing::twists_of(robot, signals, z, &rates), vector_of(point.at("true_twist"))), 1e-12);
    EXPECT_LT(apart(testing::twists_of(robot, signals, z), vector_of(point.at("twist_without_rate"))), 1e-12);
    EXPECT_LT(robot.residual_norms(signals, z, &rates)[0], 1e-12);
  }
}

// Speeds are held from a row to the next.
Matrix motions_of(const Matrix& twists, const std::vector<std::int64_t>& time_us) {
  Matrix m = twists.leftCols(twists.cols() - 1);
  for (Eigen::Index k = 0; k < m.cols(); ++k) {
    const auto i = static_cast<std::size_t>(k);
    m.col(k) *= static_cast<double>(time_us[i + 1] - time_us[i]) * 1e-6;
  }
  return m;
}

Matrix poses_by(const std::string& rule, const Matrix& motions, const Vector& start) {
  Matrix poses(3, motions.cols() + 1);
  integrate(integration_rule(rule), motions, start, poses);
  return poses;
}

void check_recording(const WheeledRobot& robot, const json& z, const json& r, const std::string& what) {
  const Vector at = parameters_of(robot, z);
  const Matrix signals = signals_of(robot, {r.at("wheel_speed"), r.at("steering")});
  const Matrix twists = testing::twists_of(robot, signals, at);
  EXPECT_LT(apart(twists, matrix_of(r.at("twist")).transpose()), 1e-12) << what;
  if (robot.is_linear()) {
    EXPECT_LT(apart(robot.matrix(at) * robot.streams(signals), matrix_of(r.at("twist")).transpose()), 1e-12)
        << what;
  }
  const Matrix motions = motions_of(twists, r.at("time_us").get<std::vector<std::int64_t>>());
  for (const auto& [rule, track] : r.at("pose_by_rule").items()) {
    const Matrix expected = matrix_of(track).transpose();
    const Matrix poses = poses_by(rule, motions, expected.col(0));
    EXPECT_LT((poses - expected).cwiseAbs().maxCoeff(), 1e-12) << what << " " << rule;
    if (!r.contains("true_pose")) continue;
    const Matrix error = (poses - matrix_of(r.at("true_pose")).transpose()).cwiseAbs();
    const Vector largest = error.rowwise().maxCoeff();
    if (r.contains("error_of_rule_m_rad")) {
      EXPECT_LT((largest - vector_of(r.at("error_of_rule_m_rad").at(rule))).norm(), 1e-12)
          << what << " " << rule;
    } else if (rule == "arc") {  // pieces of constant twist
      EXPECT_LT(largest.maxCoeff(), 1e-12) << what;
    } else if (rule == "euler") {
      EXPECT_GT(largest.maxCoeff(), 1e-3) << what;
    }
  }
}

TEST(RobotsReference, Recordings) {
  ODOBENCH_NEEDS_SHARED();
  for (const Named& named : kRobots) {
    const WheeledRobot robot(make_robot(layout(named.layout), named.dimensions));
    const json& entry = reference().at(named.key);
    ASSERT_EQ(entry.at("recordings").size(), 2u);
    for (const json& r : entry.at("recordings"))
      check_recording(robot, entry.at("z"), r, named.key + " " + r.at("kind").get<std::string>());
  }
  const WheeledRobot robot(make_robot(layout("bicycle")));
  for (const json& r : reference().at("bicycle").at("recordings"))
    check_recording(robot, r.at("z"), r, "bicycle");
}

// An increment in row j belongs to the interval before it.
TEST(RobotsReference, Increments) {
  ODOBENCH_NEEDS_SHARED();
  int seen = 0;
  for (const Named& named : kRobots) {
    const WheeledRobot robot(make_robot(layout(named.layout), named.dimensions));
    const json& entry = reference().at(named.key);
    for (const json& r : entry.at("recordings")) {
      if (!r.contains("pose_from_increments_arc")) continue;
      const Matrix increments = signals_of(robot, {r.at("wheel_angle_increment")});
      const Matrix motions = testing::twists_of(robot, increments.rightCols(increments.cols() - 1),
                                                parameters_of(robot, entry.at("z")));
      const Matrix expected = matrix_of(r.at("pose_from_increments_arc")).transpose();
      EXPECT_LT((poses_by("arc", motions, expected.col(0)) - expected).cwiseAbs().maxCoeff(), 1e-12)
          << named.key;
      ++seen;
    }
  }
  EXPECT_EQ(seen, 4);
}

}  // namespace
}  // namespace odobench::robots
