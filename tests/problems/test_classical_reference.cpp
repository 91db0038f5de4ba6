// Classical calibrations of OptiOdom's drives and of ideal ones, against an independent evaluation.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "problems/calibration/classical/classical.hpp"
#include "tests/support/data/optiodom.hpp"

namespace odobench::classical {
namespace {

using nlohmann::json;
using testing::optiodom_reference;
using testing::optiodom_set;
using testing::their_parameters;
using testing::vector_of_json;

constexpr double kTolerance = 1e-9;

void expect_near(const Vector& found, const json& list, double tolerance, const std::string& what) {
  const Vector expected = vector_of_json(list);
  ASSERT_EQ(found.size(), expected.size()) << what;
  for (Eigen::Index i = 0; i < found.size(); ++i)
    EXPECT_NEAR(found[i], expected[i], tolerance * std::max(1.0, std::abs(expected[i]))) << what << " " << i;
}
void expect_figure(const Result& r, const std::string& name, const json& value, const std::string& what) {
  const double expected = value.get<double>();
  EXPECT_NEAR(r.figure(name), expected, kTolerance * std::max(1.0, std::abs(expected)))
      << what << " " << name;
}

// Names of the reference and ours.
const std::map<std::string, std::string> kSquares = {{"umbmark_x", "umbmark"},
                                                     {"umbmark_y", "umbmark_y"},
                                                     {"jung_chung", "jung_chung"},
                                                     {"jung_chung_as_in_optiodom", "jung_chung_optiodom"}};
const std::map<std::string, std::string> kFigures = {{"alpha", "alpha"},
                                                     {"beta", "beta"},
                                                     {"R", "R"},
                                                     {"Eb", "Eb"},
                                                     {"Ed", "Ed"},
                                                     {"theta_cw", "theta_cw"},
                                                     {"theta_ccw", "theta_ccw"},
                                                     {"alpha_Eb", "alpha_b"},
                                                     {"beta_Ed", "beta_d"},
                                                     {"alpha_Ed", "alpha_d"}};

void check_square_method(const std::string& key, const json& expected, const Robot& robot,
                         const std::vector<Recording>& recordings, const Options& options, const json& before,
                         const std::string& what) {
  const Result r = method(kSquares.at(key)).run(robot, recordings, options);
  expect_near(their_parameters("diff", r.z), expected.at("z"), kTolerance, what);
  int figures = 0;
  for (const auto& [theirs, ours] : kFigures)
    if (expected.contains(theirs)) {
      expect_figure(r, ours, expected.at(theirs), what);
      ++figures;
    }
  EXPECT_GE(figures, 5) << what;
  if (expected.contains("centre_cw")) {
    expect_figure(r, "x_cw", expected.at("centre_cw")[0], what);
    expect_figure(r, "y_cw", expected.at("centre_cw")[1], what);
    expect_figure(r, "x_ccw", expected.at("centre_ccw")[0], what);
    expect_figure(r, "y_ccw", expected.at("centre_ccw")[1], what);
  }
  for (const std::string name : {"r_cw", "r_ccw", "E_max_syst"}) {
    const json& after = expected.contains("measure") ? expected.at("measure") : expected.at("measure_after");
    expect_figure(r, name, before.at(name), what);
    expect_figure(r, name + "_after", after.at(name), what);
  }
}

TEST(ClassicalReference, SquaresOfOptiodom) {
  ODOBENCH_NEEDS_OPTIODOM();
  int sets = 0;
  for (const auto& [folder, set] : optiodom_reference().items()) {
    if (!set.at("classical").contains("umbmark_x")) continue;
    ++sets;
    const Dataset& data = optiodom_set(folder);
    Options options;
    options.side = set.at("side").get<double>();
    for (const auto& [key, name] : kSquares)
      check_square_method(key, set.at("classical").at(key), data.robot, data.recordings, options,
                          set.at("umbmark_measure").at("nominal"), folder + " " + key);
    // The side from the path, where it is not given.
    EXPECT_NEAR(method("umbmark").run(data.robot, data.recordings, {}).figure("side"), options.side,
                0.02 * options.side);
    // The spread about the centres: of the same errors as robots_final_pose.json has.
    const json& errors =
        optiodom_reference("robots_final_pose.json").at("sets").at(folder).at("nominal").at("per_run");
    const Result r = method("umbmark").run(data.robot, data.recordings, options);
    for (const int sense : {0, 1}) {
      double sx = 0, sy = 0, sum = 0;
      const std::size_t half = errors.size() / 2, from = sense == 0 ? 0 : half;
      for (std::size_t i = from; i < from + half; ++i) {
        sx += errors[i][0].get<double>() / static_cast<double>(half);
        sy += errors[i][1].get<double>() / static_cast<double>(half);
      }
      for (std::size_t i = from; i < from + half; ++i)
        sum += std::pow(errors[i][0].get<double>() - sx, 2) + std::pow(errors[i][1].get<double>() - sy, 2);
      EXPECT_NEAR(r.figure(sense == 0 ? "spread_cw" : "spread_ccw"),
                  std::sqrt(sum / static_cast<double>(half - 1)), 1e-12);
    }
  }
  EXPECT_EQ(sets, 2);
}

TEST(ClassicalReference, OtherMethodsOfTheDifferentialRobot) {
  ODOBENCH_NEEDS_OPTIODOM();
  int circles = 0, ivanjko = 0, any = 0;
  for (const auto& [folder, set] : optiodom_reference().items()) {
    if (set.at("type") != "diff") continue;
    const Dataset& data = optiodom_set(folder);
    const json& classical = set.at("classical");
    const auto run = [&](const std::string& name) {
      return method(name).run(data.robot, data.recordings, {});
    };
    const auto z_of = [](const Result& r) { return their_parameters("diff", r.z); };
    if (classical.contains("circle_pair")) {
      ++circles;
      expect_near(z_of(run("circles")), classical.at("circle_pair").at("z"), kTolerance, folder + " circles");
    }
    if (classical.contains("ivanjko")) {
      ++ivanjko;
      const Result r = run("ivanjko");
      expect_near(z_of(r), classical.at("ivanjko").at("z"), 1e-7, folder + " ivanjko");
      EXPECT_EQ(r.figure("rounds"), classical.at("ivanjko").at("iterations").get<double>()) << folder;
      EXPECT_NEAR(r.figure("k_cw"), classical.at("ivanjko").at("KL_cw_last").get<double>(), 1e-7) << folder;
      EXPECT_NEAR(r.figure("k_ccw"), classical.at("ivanjko").at("KL_ccw_last").get<double>(), 1e-7) << folder;
    }
    ++any;
    const Result antonelli = run("antonelli");
    expect_near(z_of(antonelli), classical.at("antonelli").at("z"), kTolerance, folder + " antonelli");
    expect_figure(antonelli, "a_right", classical.at("antonelli").at("v_right_left")[0], folder);
    expect_figure(antonelli, "a_left", classical.at("antonelli").at("v_right_left")[1], folder);
    expect_figure(antonelli, "C_right", classical.at("antonelli").at("omega_right_left")[0], folder);
    expect_figure(antonelli, "C_left", classical.at("antonelli").at("omega_right_left")[1], folder);
    expect_figure(antonelli, "b_right", classical.at("antonelli").at("b_from_right_left")[0], folder);
    expect_figure(antonelli, "b_left", classical.at("antonelli").at("b_from_right_left")[1], folder);
    expect_near(z_of(run("censi")), classical.at("censi_centred").at("z"), kTolerance, folder + " censi");
    const Result mounted = run("censi_mount");
    expect_near(z_of(mounted), classical.at("censi_with_sensor").at("z"), kTolerance,
                folder + " censi_mount");
    expect_near(mounted.mount, classical.at("censi_with_sensor").at("sensor"), kTolerance,
                folder + " sensor");
  }
  EXPECT_EQ(circles, 2);
  EXPECT_EQ(ivanjko, 2);
  EXPECT_EQ(any, 8);
}

TEST(ClassicalReference, TricycleAndOmnidirectionalRobots) {
  ODOBENCH_NEEDS_OPTIODOM();
  int kallasi = 0, lin = 0;
  for (const auto& [folder, set] : optiodom_reference().items()) {
    const std::string type = set.at("type");
    const Dataset& data = optiodom_set(folder);
    const json& classical = set.at("classical");
    if (classical.contains("kallasi")) {
      ++kallasi;
      const Result r = method("kallasi").run(data.robot, data.recordings, {});
      expect_near(their_parameters(type, r.z), classical.at("kallasi").at("z"), kTolerance, folder);
      const double per_count = 2 * kPi / (set.at("gear").get<double>() * set.at("encoder").get<double>());
      EXPECT_NEAR(r.figure("P1") * per_count, classical.at("kallasi").at("P")[0].get<double>(), 1e-12)
          << folder;
      EXPECT_NEAR(r.figure("P2") * per_count, classical.at("kallasi").at("P")[1].get<double>(), 1e-12)
          << folder;
    }
    if (classical.contains("lin")) {
      ++lin;
      const Result r = method("lin").run(data.robot, data.recordings, {});
      EXPECT_EQ(r.z.size(), 0);
      for (Eigen::Index row = 0; row < 3; ++row) {
        Vector found = r.matrix.row(row).transpose();
        if (type == "omni4") found.tail<3>()[0] *= -1, found.tail<1>() *= -1;  // counted backwards there
        expect_near(found, classical.at("lin").at("J")[static_cast<std::size_t>(row)], kTolerance, folder);
      }
    }
  }
  EXPECT_EQ(kallasi, 4);
  EXPECT_EQ(lin, 7);
}

// Exactly the methods apply that the reference has for a set.
TEST(ClassicalReference, MethodsApplyWhereTheyShould) {
  ODOBENCH_NEEDS_OPTIODOM();
  const std::map<std::string, std::string> names = {{"umbmark_x", "umbmark"},
                                                    {"umbmark_y", "umbmark_y"},
                                                    {"jung_chung", "jung_chung"},
                                                    {"jung_chung_as_in_optiodom", "jung_chung_optiodom"},
                                                    {"circle_pair", "circles"},
                                                    {"ivanjko", "ivanjko"},
                                                    {"kallasi", "kallasi"},
                                                    {"lin", "lin"},
                                                    {"antonelli", "antonelli"},
                                                    {"censi_centred", "censi"},
                                                    {"censi_with_sensor", "censi_mount"}};
  for (const auto& [folder, set] : optiodom_reference().items()) {
    const Dataset& data = optiodom_set(folder);
    std::set<std::string> expected, found;
    for (const auto& [key, value] : set.at("classical").items()) expected.insert(names.at(key));
    for (const Method& m : methods())
      if (m.why_not(data.robot, data.recordings, {}).empty()) found.insert(m.name);
    EXPECT_EQ(found, expected) << folder;
  }
}

// Drives of the reference as recordings: counts of both wheels, poses of the robot or a sensor.
std::vector<Recording> recordings_of(const json& runs, const json& poses, double counts_per_turn) {
  std::vector<Recording> list;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    Recording r;
    r.id = "run-" + std::to_string(i + 1);
    r.trajectory = "drive";
    r.repetition = static_cast<int>(i) + 1;
    r.signals = {{"wheel.right", SignalKind::Increment, {}}, {"wheel.left", SignalKind::Increment, {}}};
    for (const json& ticks : runs[i].at("ticks_right_left")) {
      r.time_us.push_back(static_cast<std::int64_t>(r.time_us.size()) * 50'000);
      for (const std::size_t wheel : {0, 1})
        r.signals[wheel].values.push_back(ticks[wheel].get<double>() * 2 * kPi / counts_per_turn);
    }
    for (const json& pose : poses.is_null() ? runs[i].at("true_pose") : poses[i]) {
      r.reference.x.push_back(pose[0].get<double>());
      r.reference.y.push_back(pose[1].get<double>());
      r.reference.theta.push_back(pose[2].get<double>());
    }
    list.push_back(std::move(r));
  }
  return list;
}
Robot differential(const json& nominal) {
  std::vector<RobotParameter> p = {{"b", "m", nominal[0].get<double>(), 0, 0},
                                   {"r_right", "m", nominal[1].get<double>() / 2, 0, 0},
                                   {"r_left", "m", nominal[2].get<double>() / 2, 0, 0}};
  for (RobotParameter& parameter : p) set_default_box(parameter);
  return robot_of_class("differential", p);
}
// A reference at these rows alone, so that they are the sample rows.
void keep_reference(std::vector<Recording>& recordings, const json& rows) {
  for (Recording& r : recordings) {
    const Reference all = r.reference;
    r.reference = {{0}, {all.x[0]}, {all.y[0]}, {all.theta[0]}};
    for (const json& row : rows) {
      const auto k = row.get<std::size_t>();
      r.reference.sample.push_back(k);
      r.reference.x.push_back(all.x[k]);
      r.reference.y.push_back(all.y[k]);
      r.reference.theta.push_back(all.theta[k]);
    }
  }
}

TEST(ClassicalReference, IdealSquares) {
  ODOBENCH_NEEDS_SHARED();
  const json& sets = optiodom_reference("robots_classical.json").at("differential");
  ASSERT_EQ(sets.size(), 3u);
  for (const json& set : sets) {
    const double counts = set.at("gear").get<double>() * set.at("encoder").get<double>();
    const Robot robot = differential(set.at("nominal"));
    const std::vector<Recording> squares = recordings_of(set.at("runs"), nullptr, counts);
    Options options;
    options.side = set.at("side").get<double>();
    options.least_runs = 1;
    for (const std::string key : {"umbmark_x", "umbmark_y", "jung_chung"})
      check_square_method(key, set.at(key), robot, squares, options, set.at("umbmark_measure_nominal"), key);
    options.nominal_track = true;
    check_square_method("umbmark_x", set.at("umbmark_x_nominal_base"), robot, squares, options,
                        set.at("umbmark_measure_nominal"), "nominal track");
    // The side from the path, where it is not given.
    Options free = options;
    free.side = 0;
    EXPECT_NEAR(method("umbmark").run(robot, squares, free).figure("side"), options.side,
                0.01 * options.side);
  }
}

TEST(ClassicalReference, IdealCircles) {
  ODOBENCH_NEEDS_SHARED();
  for (const json& set : optiodom_reference("robots_classical.json").at("differential")) {
    const double counts = set.at("gear").get<double>() * set.at("encoder").get<double>();
    const Robot robot = differential(set.at("nominal"));
    const json& circle = set.at("circle");
    std::vector<Recording> drives = recordings_of(circle.at("runs"), nullptr, counts);
    expect_near(their_parameters("diff", method("circles").run(robot, drives, {}).z), set.at("true"), 1e-11,
                "circles");
    keep_reference(drives, circle.at("sample_rows"));
    Options every;
    every.distance = 1e-6;
    const Result antonelli = method("antonelli").run(robot, drives, every);
    expect_near(their_parameters("diff", antonelli.z), set.at("true"), 1e-11, "antonelli");
    expect_figure(antonelli, "a_right", circle.at("antonelli").at("v_right_left")[0], "ideal");
    expect_figure(antonelli, "C_left", circle.at("antonelli").at("omega_right_left")[1], "ideal");
    expect_near(their_parameters("diff", method("censi").run(robot, drives, every).z), set.at("true"), 1e-11,
                "censi");
    std::vector<Recording> seen =
        recordings_of(circle.at("runs"), circle.at("mounted").at("sensor_pose"), counts);
    keep_reference(seen, circle.at("sample_rows"));
    const Result mounted = method("censi_mount").run(robot, seen, every);
    expect_near(their_parameters("diff", mounted.z), set.at("true"), 1e-11, "censi_mount");
    expect_near(mounted.mount, circle.at("mounted").at("sensor_true"), 1e-11, "sensor");
  }
}

}  // namespace
}  // namespace odobench::classical
