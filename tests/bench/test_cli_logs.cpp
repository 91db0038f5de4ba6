// `bench import LOG... --map`, `--propose`, `bench calibrate LOG...`, as a user sees them: the right robot
// out of logs of every format, and one clear line for what is wrong.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/support/data/drive_log.hpp"
#include "tests/support/run_process.hpp"
#include "tests/support/shared_data.hpp"

namespace odobench::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;
using Args = std::vector<std::string>;

class CliLogs : public ::testing::Test {
 protected:
  // Parameters of lm by name.
  static std::map<std::string, double> calibrated(const std::filesystem::path& results) {
    std::map<std::string, double> found;
    for (const std::string& line : lines(content(results / "runs.jsonl"))) {
      const json record = json::parse(line);
      if (record.at("kind") != "run") continue;
      for (const json& p : record.at("parameters")) found[p.at("name")] = p.at("value");
    }
    return found;
  }

  static void expect_robot(const std::map<std::string, double>& found, double b, double left, double right,
                           double tolerance) {
    ASSERT_EQ(found.size(), 3U);
    EXPECT_NEAR(found.at("b"), b, tolerance * b);
    EXPECT_NEAR(found.at("r_left"), left, tolerance * left);
    EXPECT_NEAR(found.at("r_right"), right, tolerance * right);
  }

  Args drive(const DriveLog& log, const std::string& number = "") {
    return {folder_.file("ticks" + number + ".csv", log.wheels()),
            folder_.file("mocap" + number + ".csv", log.capture())};
  }

  ProcessResult calibrate(const Args& logs, const Args& options = {"--per-turn=1000"}) {
    Args words{"calibrate"};
    words.insert(words.end(), logs.begin(), logs.end());
    words.insert(words.end(), {"--nominal=b=0.4,r=0.05", "--out=" + out(), "--overwrite"});
    words.insert(words.end(), options.begin(), options.end());
    return run_bench(words);
  }
  std::string out() const { return (folder_ / "out").string(); }

  // A map for drive(), with this in the place of that.
  std::string map(const std::string& from = "", const std::string& to = "") {
    std::string text = R"({"schema": "odobench-import", "schema_version": 1, "name": "mine",
 "robot": {"name": "mine", "kinematics": "diff", "parameters": [{"name": "b", "nominal": 0.4},
   {"name": "r_right", "nominal": 0.05}, {"name": "r_left", "nominal": 0.05}]},
 "sources": {"ticks": {"files": "ticks*.csv"}, "mocap": {"files": "mocap*.csv", "offset_s": 0.137}},
 "signals": {"wheel_angle.left": {"source": "ticks", "field": "left_ticks", "unit": "count", "per_turn": 1000},
   "wheel_angle.right": {"source": "ticks", "field": "right_ticks", "unit": "count", "per_turn": 1000},
   "reference.x": {"source": "mocap", "field": "x [mm]", "unit": "mm"},
   "reference.y": {"source": "mocap", "field": "y [mm]", "unit": "mm"},
   "reference.heading": {"source": "mocap", "field": "yaw [deg]", "unit": "deg"}}})";
    if (const std::size_t at = text.find(from); !from.empty()) text.replace(at, from.size(), to);
    return folder_.file("map.json", text);
  }

  ProcessResult import(const Args& logs, const std::string& map, const Args& more = {}) {
    Args words{"import"};
    words.insert(words.end(), logs.begin(), logs.end());
    words.insert(words.end(), {"--map=" + map, "--out=" + (folder_ / "set.json").string(), "--overwrite"});
    words.insert(words.end(), more.begin(), more.end());
    return run_bench(words);
  }
  json set() const { return json::parse(content(folder_ / "set.json")); }

  TemporaryFolder folder_;
};

TEST_F(CliLogs, CalibratesCountsAndCaptureOfTwoClocks) {
  const ProcessResult run = calibrate(drive({}));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("clock of the reference runs 0.137 s ahead"));
  expect_robot(calibrated(folder_ / "out/results"), 0.412, 0.0504, 0.04985, 1e-3);
  for (const char* file : {"map.json", "set.json", "report.html"})
    EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / file)) << file;
}

TEST_F(CliLogs, ProposesSignsSidesAndWhatIsOpen) {
  DriveLog log;
  log.left_sign = -1;
  Args logs = drive(log);
  // The names are the wrong way round, too.
  std::string text = content(logs[0]);
  text.replace(text.find("left_ticks,right_ticks"), 22, "right_ticks,left_ticks");
  folder_.file("ticks.csv", text);
  const ProcessResult run = run_bench({"import", logs[0], logs[1], "--propose"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("exchanged"));
  const json map = json::parse(run.out);
  EXPECT_EQ(map["signals"]["wheel_angle.left"]["field"], "right_ticks");
  EXPECT_EQ(map["signals"]["wheel_angle.left"]["sign"], -1);
  EXPECT_FALSE(map["signals"]["wheel_angle.right"].contains("sign"));
  EXPECT_TRUE(map["signals"]["wheel_angle.left"]["per_turn"].is_null());
  EXPECT_TRUE(map["robot"]["parameters"][0]["nominal"].is_null());
  const ProcessResult calibration = calibrate(logs);
  ASSERT_EQ(calibration.exit_code, 0) << calibration.err;
  expect_robot(calibrated(folder_ / "out/results"), 0.412, 0.0504, 0.04985, 1e-3);
}

// A camera's odometry as a file: its heading walks by 0.03 rad in a metre, it sits 11 cm before the axle and
// has a clock of its own. Over 1.8 m that hides the ratio of the wheels to drift * b / sqrt(way) = 0.9 %.
TEST_F(CliLogs, AnotherOdometryIsAReferenceThatDrifts) {
  double squares = 0;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    DriveLog log;
    log.drift = 0.03;
    log.drift_seed = seed;
    log.mount_x = 0.11;
    log.mount_y = 0.02;
    const Args logs{folder_.file("ticks.csv", log.wheels()),
                    folder_.file("visual_odometry.csv", log.capture())};
    const ProcessResult run = calibrate(logs);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr("visual_odometry: another odometry, by its name: it drifts"));
    EXPECT_THAT(run.err, HasSubstr("the reference drifts: --cost=segments"));
    const std::map<std::string, double> found = calibrated(folder_ / "out/results");
    EXPECT_NEAR(found.at("b"), DriveLog::kTrack, 0.015 * DriveLog::kTrack) << seed;
    EXPECT_NEAR(found.at("r_left") + found.at("r_right"), DriveLog::kLeft + DriveLog::kRight, 4e-4) << seed;
    const double ratio = found.at("r_right") / found.at("r_left") * DriveLog::kLeft / DriveLog::kRight;
    squares += (ratio - 1) * (ratio - 1) / 4;
    // x = 112.52 mm, y = 22.18 mm
    const std::size_t at = run.err.find("the tracked frame sits at x = ");
    ASSERT_NE(at, std::string::npos);
    EXPECT_NEAR(std::stod(run.err.substr(at + 30)), 110, 5) << seed;
  }
  EXPECT_LT(std::sqrt(squares), 0.015);
  // A cost that is asked for is taken.
  DriveLog log;
  log.drift = 0.03;
  const ProcessResult whole =
      calibrate({folder_.file("ticks.csv", log.wheels()), folder_.file("visual_odometry.csv", log.capture())},
                {"--per-turn=1000", "--cost=every_sample"});
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  EXPECT_THAT(whole.err, Not(HasSubstr("--cost=segments, of")));
}

TEST_F(CliLogs, ProposesCountersThatRunOverAndFramesThatAreMirrored) {
  DriveLog over;
  over.bits = 10;
  const ProcessResult counters = calibrate(drive(over));
  ASSERT_EQ(counters.exit_code, 0) << counters.err;
  EXPECT_THAT(counters.err, HasSubstr("wheel.left: a counter of 10 bits, which runs over"));
  expect_robot(calibrated(folder_ / "out/results"), 0.412, 0.0504, 0.04985, 1e-3);
  DriveLog mirrored;
  mirrored.y_to_the_right = true;
  const ProcessResult frame = calibrate(drive(mirrored));
  ASSERT_EQ(frame.exit_code, 0) << frame.err;
  EXPECT_THAT(frame.err, HasSubstr("the reference's frame is mirrored"));
  EXPECT_EQ(json::parse(content(folder_ / "out/map.json"))["signals"]["reference.y"]["sign"], -1);
  expect_robot(calibrated(folder_ / "out/results"), 0.412, 0.0504, 0.04985, 1e-3);
}

TEST_F(CliLogs, SaysWhatTheLogDoesNotSay) {
  const Args logs = drive({});
  const ProcessResult run = run_bench({"calibrate", logs[0], logs[1], "--out=" + out(), "--quiet"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("--nominal=b=...,r_right=...,r_left=..."));
  EXPECT_THAT(run.err, HasSubstr("--per-turn=N"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
  const ProcessResult unknown = calibrate(logs, {"--per-turn=1000", "--nominal=bb=0.4"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("--nominal: found 'bb', did you mean 'b'?"));
}

TEST_F(CliLogs, CountersThatRunOverAndPatternsOfSeveralDrives) {
  DriveLog log;
  log.bits = 10;
  Args logs = drive(log, "_1");
  const Args second = drive(log, "_2");
  logs.insert(logs.end(), second.begin(), second.end());
  const ProcessResult run = import(logs, map(R"("per_turn": 1000},
   "wheel_angle.right": {"source": "ticks", "field": "right_ticks", "unit": "count", "per_turn": 1000})",
                                             R"("per_turn": 1000, "wrap": 1024},
   "wheel_angle.right": {"source": "ticks", "field": "right_ticks", "unit": "count", "per_turn": 1000, "bits": 10})"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  ASSERT_EQ(set()["recordings"].size(), 2U);
  EXPECT_EQ(set()["provenance"]["files"].size(), 5U);
  ASSERT_EQ(
      run_bench({"--solver=lm", "--data=" + (folder_ / "set.json").string(), "--out=" + out()}).exit_code, 0);
  expect_robot(calibrated(folder_ / "out"), 0.412, 0.0504, 0.04985, 1e-3);
}

TEST_F(CliLogs, GapsAndStandstillSplitDrives) {
  DriveLog gap;
  gap.gap_from_s = 5;
  gap.gap_to_s = 5.6;
  ASSERT_EQ(import(drive(gap), map()).exit_code, 0);
  EXPECT_EQ(set()["recordings"].size(), 2U);
  EXPECT_THAT(set()["notes"].dump(), HasSubstr("reference has a gap of 0.6"));
  DriveLog stop;
  stop.stop_s = 6;
  const std::string by_standing = map("\"signals\"", R"("drives": {"split": "standstill", "standstill_s": 3,
    "names": ["bend_1", "bend_2"]}, "signals")");
  ASSERT_EQ(import(drive(stop), by_standing).exit_code, 0);
  ASSERT_EQ(set()["recordings"].size(), 2U);
  EXPECT_EQ(set()["recordings"][1]["id"], "bend_2");
  EXPECT_THAT(set()["notes"].dump(), HasSubstr("of standing left out"));
}

TEST_F(CliLogs, WhatIsWrongWithAMapIsOneLine) {
  const Args logs = drive({});
  const auto refused = [&](const std::string& from, const std::string& to, const std::string& expected,
                           int code = 3) {
    const ProcessResult run = import(logs, map(from, to));
    EXPECT_EQ(run.exit_code, code) << to;
    EXPECT_THAT(run.err, HasSubstr(expected));
    EXPECT_THAT(lines(run.err).back(), HasSubstr("bench: error: ")) << run.err;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "set.json"));
  };
  refused("\"left_ticks\"", "\"left_tick\"", "/signals/wheel.left/field");
  refused("\"left_ticks\"", "\"left_tick\"", "did you mean 'left_ticks'");
  refused("\"source\": \"ticks\"", "\"source\": \"tick\"", "did you mean 'ticks'");
  refused("\"sources\"", "\"source_s\"", "unknown key");
  refused("\"per_turn\": 1000", "\"per_turn\": null", "/signals/wheel_angle.left/per_turn");
  refused("\"wheel_angle.left\"", "\"wheel_angle.middle\"",
          "a signal \"wheel_angle.middle\" that the robot has not");
  refused("\"offset_s\": 0.137", "\"offset_s\": 1000", "overlap by 0.0 s");
  refused("\"offset_s\": 0.137", "\"offset_s\": \"guess\"", "\"estimate\"");
  refused("ticks*.csv", "tacks*.csv", "fits no pattern", 2);
  refused("\"nominal\": 0.4", "\"nominal\": null", "/robot/parameters/0/nominal");
}

TEST_F(CliLogs, ClocksThatDifferAreSaidAndNotTouched) {
  const ProcessResult run = import(drive({}), map("\"offset_s\": 0.137", "\"offset_s\": 0"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("runs 0.137 s ahead of the wheels"));
  EXPECT_THAT(run.err, HasSubstr("not applied"));
}

// A steered and driven front wheel 0.82 m ahead, radius 98.5 mm, whose steering reads 0.013 rad too little.
std::string tricycle_table() {
  double x = 0, y = 0, theta = 0, angle = 0;
  std::string csv = "time_s,traction_rad,steering_deg,x_mm,y_mm,yaw_deg\n";
  for (int k = 0; k <= 40000; ++k) {
    const double t = 1e-3 * k, degree = 3.14159265358979 / 180;
    const bool drives = t > 1 && t < 39;
    const double v = drives ? 0.02 + 0.5 * std::pow(std::sin((t - 1) * 3.14159265358979 / 38), 2) : 0;
    const double steering = drives ? 0.5 * std::sin((t - 1) / 2) : 0;
    if (k % 20 == 0)
      csv += fmt::format("{:.3f},{:.6f},{:.5f},{:.3f},{:.3f},{:.4f}\n", t, angle, (steering - 0.013) / degree,
                         1e3 * x, 1e3 * y, theta / degree);
    const double turn = v * std::sin(steering) / 0.82 * 1e-3, middle = theta + turn / 2;
    x += v * std::cos(steering) * std::cos(middle) * 1e-3;
    y += v * std::cos(steering) * std::sin(middle) * 1e-3;
    theta += turn;
    angle += v / 0.0985 * 1e-3;
  }
  return csv;
}

TEST_F(CliLogs, CalibratesATricycleFromOneTable) {
  const ProcessResult run = run_bench({"calibrate", folder_.file("drive.csv", tricycle_table()),
                                       "--nominal=wheelbase=0.8,r=0.1", "--out=" + out()});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::map<std::string, double> found = calibrated(folder_ / "out/results");
  EXPECT_NEAR(found.at("wheelbase"), 0.82, 1e-3 * 0.82);
  EXPECT_NEAR(found.at("r"), 0.0985, 1e-3 * 0.0985);
  EXPECT_NEAR(found.at("steering_zero"), 0.013, 2e-4);
  EXPECT_THAT(content(folder_ / "out/ros2.yaml"), HasSubstr("wheel_radius: 0.0985"));
}

// Four mecanum wheels, columns by their corners in an order of their own; radii 50.5, 49.5, 50, 50.2 mm (FL,
// FR, RL, RR), half distances 0.21 + 0.19 m. It drives ahead, sideways and turns, all at once.
std::string mecanum_table() {
  double x = 0, y = 0, theta = 0, fl = 0, fr = 0, rl = 0, rr = 0;
  std::string csv = "time_s,rear_left_rad,front_right_rad,front_left_rad,rear_right_rad,x_mm,y_mm,yaw_deg\n";
  for (int k = 0; k <= 30000; ++k) {
    const double t = 1e-3 * k, step = 1e-3, lever = 0.4, pi = 3.14159265358979;
    const double on = t > 1 && t < 29 ? std::pow(std::sin((t - 1) * pi / 28), 2) : 0;
    const double v = 0.4 * on * std::cos(0.9 * t), side = 0.3 * on * std::sin(0.7 * t),
                 w = 0.6 * on * std::sin(0.5 * t);
    if (k % 20 == 0)
      csv += fmt::format("{:.3f},{:.6f},{:.6f},{:.6f},{:.6f},{:.3f},{:.3f},{:.4f}\n", t, rl, fr, fl, rr,
                         1e3 * x, 1e3 * y, theta * 180 / pi);
    const double middle = theta + w * step / 2;
    x += (v * std::cos(middle) - side * std::sin(middle)) * step;
    y += (v * std::sin(middle) + side * std::cos(middle)) * step;
    theta += w * step;
    fl += (v - side - lever * w) / 0.0505 * step;
    fr += (v + side + lever * w) / 0.0495 * step;
    rl += (v + side - lever * w) / 0.05 * step;
    rr += (v - side + lever * w) / 0.0502 * step;
  }
  return csv;
}

TEST_F(CliLogs, TheClassOfTheRobotTellsWhatItsWheelsAre) {
  const std::string log = folder_.file("drive.csv", mecanum_table());
  const ProcessResult unknown = run_bench({"calibrate", log, "--out=" + out()});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("--robot=CLASS of bench calibrate says which"));
  const ProcessResult run =
      run_bench({"calibrate", log, "--robot=mecanum", "--nominal=lx=0.2,ly=0.2,r=0.05", "--out=" + out()});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::map<std::string, double> found = calibrated(folder_ / "out/results");
  EXPECT_NEAR(found.at("lx") + found.at("ly"), 0.4, 1e-3);  // the drives tell their sum only
  EXPECT_NEAR(found.at("r1"), 0.0505, 2e-5);
  EXPECT_NEAR(found.at("r2"), 0.0495, 2e-5);
  EXPECT_NEAR(found.at("r3"), 0.05, 2e-5);
  EXPECT_NEAR(found.at("r4"), 0.0502, 2e-5);
}

// The sample drive in all formats; true: 0.4120, 0.05040, 0.04985 m.
class SampleLogs : public CliLogs, public ::testing::WithParamInterface<Args> {};

TEST_P(SampleLogs, GiveTheTrueRobot) {
  ODOBENCH_NEEDS_SHARED();
  Args logs;
  for (const std::string& name : GetParam())
    logs.push_back(name.starts_with("--") ? name : (shared_folder() / "datasets/logs" / name).string());
  const ProcessResult run = calibrate(logs, {"--per-turn=4096"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  expect_robot(calibrated(folder_ / "out/results"), 0.412, 0.0504, 0.04985, 3e-4);
}

INSTANTIATE_TEST_SUITE_P(
    Logs, SampleLogs,
    ::testing::Values(Args{"courier_none.bag"}, Args{"courier_bz2.bag"}, Args{"courier_lz4.bag"},
                      Args{"courier_none.mcap"}, Args{"courier_lz4.mcap"}, Args{"courier_zstd.mcap"},
                      Args{"courier_rosbag2_plain"}, Args{"courier_rosbag2_split"},
                      Args{"courier_rosbag2_zstd_file"}, Args{"courier_rosbag2_zstd_message"},
                      Args{"courier_v5.mat"}, Args{"courier_v7.mat"}, Args{"courier.npz"},
                      Args{"courier_deflated.npz"}, Args{"drive.jsonl"}, Args{"merged_european.csv"},
                      Args{"ticks_ns.csv", "mocap_mm_deg.csv"}, Args{"wheels.txt", "mocap.tum"},
                      Args{"wheels.txt", "mocap_euroc.csv"}, Args{"wheels.txt", "mocap_kitti.txt"}),
    [](const auto& test) {
      std::string name;
      for (const std::string& part : test.param)
        for (const char c : part) name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
      return name;
    });

}  // namespace
}  // namespace odobench::testing
