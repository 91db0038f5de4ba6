// Classical calibrations on made-up drives with known parameters, and what they say where they do not apply.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/angle.hpp"
#include "problems/calibration/classical/classical.hpp"
#include "problems/robots/integration.hpp"
#include "problems/robots/wheeled_robot.hpp"

namespace odobench::classical {
namespace {

using ::testing::HasSubstr;

RobotParameter parameter(const std::string& name, double nominal, const std::string& unit = "m") {
  RobotParameter p{name, unit, nominal, 0, 0};
  set_default_box(p);
  return p;
}
Robot differential_robot(double b = 0.3, double right = 0.05, double left = 0.05) {
  return robot_of_class("differential",
                        {parameter("b", b), parameter("r_right", right), parameter("r_left", left)});
}

// A drive: twists (vx, vy, omega) of pieces of one second each.
using Twists = std::vector<Eigen::Vector3d>;
constexpr int kStepsPerPiece = 20;

// What the wheels of a robot with the values `z` say when it drives like this, and where it went.
Recording drive(const Robot& robot, const Vector& z, const std::string& id, const Twists& twists,
                SignalKind kind = SignalKind::Increment) {
  const robots::WheeledRobot wheels(robot.table);
  Recording r;
  r.id = id;
  r.trajectory = "drive";
  r.repetition = 1;
  for (std::size_t i = 0; i < wheels.signals().size(); ++i)
    r.signals.push_back({wheels.signals()[i],
                         static_cast<Eigen::Index>(i) < wheels.drive_count() ? kind : SignalKind::Angle,
                         {}});
  constexpr double kStep = 1.0 / kStepsPerPiece;
  Matrix motions(3, static_cast<Eigen::Index>(twists.size()) * kStepsPerPiece);
  for (Eigen::Index k = 0; k < motions.cols(); ++k)
    motions.col(k) = kStep * twists[static_cast<std::size_t>(k / kStepsPerPiece)];
  Matrix poses(3, motions.cols() + 1);
  robots::integrate(robots::IntegrationRule::Arc, motions, Eigen::Vector3d::Zero(), poses);
  const bool speeds = kind == SignalKind::Speed;
  for (Eigen::Index k = 0; k <= motions.cols(); ++k) {
    r.time_us.push_back(k * 1'000'000 / kStepsPerPiece);
    r.reference.x.push_back(poses(0, k));
    r.reference.y.push_back(poses(1, k));
    r.reference.theta.push_back(poses(2, k));
  }
  for (auto& signal : r.signals) signal.values.assign(r.size(), 1e9);  // the entry that is never used
  for (Eigen::Index k = 0; k < motions.cols(); ++k) {
    const Vector s = wheels.inverse(motions.col(k), z);
    for (std::size_t i = 0; i < r.signals.size(); ++i) {
      const bool angle = r.signals[i].kind == SignalKind::Angle;
      r.signals[i].values[static_cast<std::size_t>(k) + (speeds ? 0 : 1)] =
          s[static_cast<Eigen::Index>(i)] / (speeds && !angle ? kStep : 1);
    }
  }
  return r;
}

Twists square(double sense, double side = 2, double turn = kPi / 2) {
  Twists twists;
  for (int i = 0; i < 4; ++i) {
    twists.push_back({side, 0, 0});
    twists.push_back({0, 0, sense * turn});
  }
  return twists;
}
Twists circle(double sense, double radius = 1, int pieces = 5) {
  return Twists(static_cast<std::size_t>(pieces), {radius, 0, sense});
}
// Different curvatures, both senses.
const Twists kFree = {{1, 0, 0.5}, {1, 0, -0.8}, {0.7, 0, 0}, {0.5, 0, 1.2}, {1, 0, 0.3}, {0.6, 0, -1.5}};

const Vector kTrue = (Vector(3) << 0.306, 0.0505, 0.0498).finished();

std::vector<Recording> squares(const Vector& z) {
  std::vector<Recording> list;
  for (int i = 0; i < 4; ++i)
    list.push_back(drive(differential_robot(), z, fmt::format("square_{}", i + 1), square(i < 2 ? -1 : 1)));
  return list;
}

void expect_truth(const Vector& found, const Vector& truth, double tolerance, const std::string& what) {
  ASSERT_EQ(found.size(), truth.size()) << what;
  for (Eigen::Index i = 0; i < truth.size(); ++i)
    EXPECT_NEAR(found[i], truth[i], tolerance * std::max(std::abs(truth[i]), 0.01)) << what << " " << i;
}

TEST(Classical, ExactDrivesGiveTheTruth) {
  const Robot robot = differential_robot();
  for (const SignalKind kind : {SignalKind::Increment, SignalKind::Speed}) {
    const std::vector<Recording> free = {drive(robot, kTrue, "free", kFree, kind)};
    for (const std::string name : {"antonelli", "censi", "censi_mount"})
      expect_truth(method(name).run(robot, free, {}).z, kTrue, 1e-10, name);
    EXPECT_LT(method("censi_mount").run(robot, free, {}).mount.norm(), 1e-10);
    const std::vector<Recording> circles = {drive(robot, kTrue, "cw", circle(-1), kind),
                                            drive(robot, kTrue, "ccw", circle(1), kind)};
    expect_truth(method("circles").run(robot, circles, {}).z, kTrue, 1e-10, "circles");
    const std::vector<Recording> lines = {drive(robot, kTrue, "line", {{1, 0, 0}, {1, 0, 0}}, kind),
                                          drive(robot, kTrue, "cw", {{0, 0, -kPi}}, kind),
                                          drive(robot, kTrue, "ccw", {{0, 0, kPi}}, kind)};
    // Its rounds end within 1e-3, where a track error no longer matters to the radii of exact lines.
    expect_truth(method("ivanjko").run(robot, lines, {}).z, kTrue, 1e-6, "ivanjko");
  }
}

// Squares tell the track and the ratio of radii, not the mean radius.
TEST(Classical, SquaresGiveTrackAndRatio) {
  const Robot robot = differential_robot();
  const Vector truth = (Vector(3) << 0.3045, 0.05002, 0.04998).finished();
  const std::vector<Recording> drives = squares(truth);
  const auto found = [&](const char* name) { return method(name).run(robot, drives, {}); };
  for (const char* name : {"umbmark", "umbmark_y", "jung_chung"}) {
    const Result r = found(name);
    expect_truth(r.z, truth, 3e-3, name);
    EXPECT_GT(std::abs(robot.parameters[0].nominal - truth[0]) / truth[0], 1e-2)
        << "or it would prove nothing";
    EXPECT_NEAR(r.z[1] + r.z[2], 0.1, 1e-5) << "the mean radius stays";
    EXPECT_LT(r.figure("E_max_syst_after"), 0.2 * r.figure("E_max_syst")) << name;
    EXPECT_NEAR(r.figure("spread_cw"), 0, 1e-12) << "runs that are alike";
  }
  EXPECT_LT(std::abs(found("jung_chung").z[1] - truth[1]), std::abs(found("umbmark").z[1] - truth[1]));
}

TEST(Classical, WheelsThatAgreeLeaveRadiiAlone) {
  const Robot robot = differential_robot();
  const Result r = method("jung_chung").run(robot, squares((Vector(3) << 0.305, 0.05, 0.05).finished()), {});
  EXPECT_NEAR(r.figure("Ed"), 1, 1e-12);
  EXPECT_NEAR(r.z[1], 0.05, 1e-13);
}

// A tape measure at the end gives the same as motion capture all along.
TEST(Classical, SquaresNeedTheEndOnly) {
  const Robot robot = differential_robot();
  const std::vector<Recording> drives = squares(kTrue);
  std::vector<Recording> ends = drives;
  for (Recording& r : ends) {
    const Reference all = r.reference;
    r.reference = {{r.size() - 1}, {all.x.back()}, {all.y.back()}, {wrapped_angle(all.theta.back())}};
  }
  for (const char* name : {"umbmark", "jung_chung"})
    expect_truth(method(name).run(robot, ends, {}).z, method(name).run(robot, drives, {}).z, 1e-12, name);
}

// The start pose and the order of the runs are of no consequence.
TEST(Classical, StartAndOrderDoNotMatter) {
  const Robot robot = differential_robot();
  std::vector<Recording> drives = squares(kTrue);
  const Vector before = method("umbmark").run(robot, drives, {}).z;
  const double c = std::cos(0.7), s = std::sin(0.7);
  for (Recording& r : drives)
    for (std::size_t k = 0; k < r.size(); ++k) {
      const double x = r.reference.x[k], y = r.reference.y[k];
      r.reference.x[k] = 3 + c * x - s * y;
      r.reference.y[k] = -1 + s * x + c * y;
      r.reference.theta[k] += 0.7;
    }
  std::reverse(drives.begin(), drives.end());
  expect_truth(method("umbmark").run(robot, drives, {}).z, before, 1e-12, "moved");
}

TEST(Classical, TricycleByKallasi) {
  const auto robot_with = [](double r, double zero) {
    return robot_of_class("tricycle", {parameter("wheelbase", 0.5), parameter("r", r),
                                       parameter("steering_zero", zero, "rad")});
  };
  const Robot robot = robot_with(0.05, 0);
  const Vector truth = (Vector(3) << 0.5, 0.053, 0.04).finished();
  const std::vector<Recording> drives = {drive(robot, truth, "free", kFree)};
  expect_truth(method("kallasi").run(robot, drives, {}).z, truth, 1e-10, "kallasi");
  // Another wheelbase: the radius comes out in proportion, the zero stays.
  const Vector longer = (Vector(3) << 0.55, 0.053, 0.04).finished();
  const Vector found = method("kallasi").run(robot, {drive(robot, longer, "free", kFree)}, {}).z;
  EXPECT_NEAR(found[1], 0.053 / 1.1, 1e-10);
  EXPECT_NEAR(found[2], 0.04, 1e-10);
}

// It takes each row's motion along the heading at the row's end, so short rows come nearest.
TEST(Classical, OmniByLin) {
  const Twists twists = {
      {0.5, 0.2, 0.1}, {0.1, -0.4, -0.2}, {-0.3, 0.3, 0.3}, {0.2, 0.6, 0.45}, {0.3, 0, -0.6}};
  const Robot three = robot_of_class(
      "omni3", {parameter("R", 0.2), parameter("r1", 0.05), parameter("r2", 0.05), parameter("r3", 0.05)});
  const Robot four =
      robot_of_class("mecanum", {parameter("lx", 0.2), parameter("ly", 0.15), parameter("r1", 0.05),
                                 parameter("r2", 0.05), parameter("r3", 0.05), parameter("r4", 0.05)});
  for (const Robot& robot : {three, four}) {
    const robots::WheeledRobot wheels(robot.table);
    const Matrix truth = wheels.matrix(wheels.nominal()) / 0.05;  // by paths instead of angles
    const Result r =
        method("lin").run(robot, {drive(robot, wheels.nominal(), "free", twists)}, {.distance = 0.05});
    ASSERT_EQ(r.matrix.cols(), truth.cols());
    EXPECT_LT((r.matrix.row(2) - truth.row(2)).norm(), 1e-9) << robot.kinematics;
    EXPECT_LT((r.matrix.topRows(2) - truth.topRows(2)).norm(), 0.05) << robot.kinematics << r.matrix;
    EXPECT_GT((r.matrix.topRows(2) - truth.topRows(2)).norm(), 1e-6) << "the method's own error";
    EXPECT_EQ(r.z.size(), 0);
  }
}

std::string reason(const char* name, const Robot& robot, const std::vector<Recording>& recordings,
                   const Options& options = {}) {
  const std::string text = method(name).why_not(robot, recordings, options);
  EXPECT_EQ(text.find('\n'), std::string::npos);
  if (text.empty()) return text;
  try {
    method(name).run(robot, recordings, options);
    ADD_FAILURE() << "runs although " << text;
  } catch (const std::invalid_argument& e) {
    EXPECT_EQ(std::string(e.what()), fmt::format("{}: {}", name, text));
  }
  return text;
}

TEST(Classical, ReasonsOfSquares) {
  const Robot robot = differential_robot();
  const std::vector<Recording> good = squares(kTrue);
  EXPECT_EQ(reason("umbmark", robot, good), "");
  EXPECT_EQ(reason("umbmark", robot, {}), "there are no recordings");
  EXPECT_THAT(reason("umbmark", robot, {good[0], good[1]}),
              HasSubstr("0 of the squares are driven counter-clockwise, expected at least 2 in each sense"));
  EXPECT_THAT(reason("jung_chung", robot, {good[0], good[2], good[3]}),
              HasSubstr("1 of the squares are driven clockwise, expected at least 2"));
  Options one;
  one.least_runs = 1;
  EXPECT_EQ(reason("umbmark", robot, {good[0], good[2]}, one), "");
  std::vector<Recording> drives = good;
  drives[1] = drive(robot, kTrue, "half", {{1, 0, -kPi}});
  EXPECT_THAT(reason("umbmark", robot, drives), HasSubstr("recording half turns 0.5"));
  drives[1] = drive(robot, kTrue, "round", circle(-1, 1, 6));
  EXPECT_THAT(reason("umbmark", robot, drives), HasSubstr("recording round does not follow four directions"));
  drives[1] = drive(robot, kTrue, "spin", {{0, 0, -2 * kPi}});
  EXPECT_THAT(reason("umbmark", robot, drives), HasSubstr("recording spin"));
  drives = good;
  drives[1].reference.x.back() += 0.6;
  EXPECT_THAT(reason("umbmark", robot, drives), HasSubstr("recording square_2 ends 0."));
  drives = good;
  Options wrong;
  wrong.side = 3;
  EXPECT_THAT(reason("umbmark", robot, drives, wrong),
              HasSubstr("expected about 12.00 m: a square of 3.00 m"));
}

TEST(Classical, ReasonsOfOtherDrives) {
  const Robot robot = differential_robot();
  const Recording cw = drive(robot, kTrue, "cw", circle(-1)), ccw = drive(robot, kTrue, "ccw", circle(1));
  EXPECT_EQ(reason("circles", robot, {cw, ccw}), "");
  EXPECT_THAT(reason("circles", robot, {cw}), HasSubstr("no circle is driven counter-clockwise"));
  EXPECT_THAT(reason("circles", robot, squares(kTrue)), HasSubstr("as of a circle"));
  const Recording line = drive(robot, kTrue, "line", {{1, 0, 0}, {1, 0, 0}});
  EXPECT_THAT(reason("circles", robot, {cw, ccw, line}), HasSubstr("recording line turns by"));
  const Recording spin = drive(robot, kTrue, "spin", {{0, 0, kPi}});
  const Recording back = drive(robot, kTrue, "back", {{0, 0, -kPi}});
  EXPECT_EQ(reason("ivanjko", robot, {line, spin, back}), "");
  EXPECT_THAT(reason("ivanjko", robot, {line, spin}), HasSubstr("no recording turns clockwise on the spot"));
  EXPECT_THAT(reason("ivanjko", robot, {spin, back}), HasSubstr("no recording is a straight line"));
  EXPECT_THAT(reason("ivanjko", robot, {line, spin, cw}), HasSubstr("recording cw turns along a path of"));
  EXPECT_THAT(
      reason("ivanjko", robot, {drive(robot, kTrue, "bend", {{1, 0, 1.4}, {1, 0, -1.4}, {1, 0, -1.4}})}),
      HasSubstr("recording bend ends"));
  EXPECT_THAT(reason("censi", robot, {line}), HasSubstr("rad, expected at least 0.5 rad"));
  EXPECT_THAT(reason("antonelli", robot, {spin}), HasSubstr("sample rows at 0.5 m, expected at least 4"));
}

TEST(Classical, ReasonsOfRobotsAndSignals) {
  const Robot robot = differential_robot();
  const Robot bicycle = robot_of_class("bicycle", {});
  for (const Method& m : methods()) {
    EXPECT_THAT(reason(m.name.c_str(), bicycle, {}), HasSubstr("the robot is of class bicycle, expected "));
    EXPECT_FALSE(m.description.empty());
  }
  const Robot tied = robot_of_class("differential", {}, {}, {{"r_left", "r_right"}});
  EXPECT_THAT(reason("censi", tied, {}), HasSubstr("no parameter 'r_left' of its own"));
  Recording free = drive(robot, kTrue, "free", kFree);
  free.signals.pop_back();
  EXPECT_THAT(reason("censi", robot, {free}), HasSubstr("has no signal 'wheel.left'"));
  try {
    method("umbmarc");
    ADD_FAILURE();
  } catch (const std::invalid_argument& e) {
    EXPECT_THAT(e.what(), HasSubstr("unknown classical method 'umbmarc', did you mean 'umbmark'?"));
  }
}

// Pieces of one curvature do not tell the sensor's place.
TEST(Classical, RefusesWhatHasNoSolution) {
  const Robot robot = differential_robot();
  const std::vector<Recording> round = {drive(robot, kTrue, "round", circle(1))};
  for (const char* name : {"antonelli", "censi", "censi_mount"}) {
    ASSERT_EQ(method(name).why_not(robot, round, {}), "");
    EXPECT_THROW(method(name).run(robot, round, {}), std::invalid_argument) << name;
  }
}

}  // namespace
}  // namespace odobench::classical
