// Calibration without motion capture, from a bag to intervals: a camera's odometry that drifts and sits
// anywhere, and nothing but a gyro.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/support/data/robot_bag.hpp"
#include "tests/support/run_process.hpp"

namespace odobench::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

class OwnReferences : public ::testing::Test {
 protected:
  std::string write(const RobotBag& bag, const std::string& format) {
    const std::string name = "drive_" + std::to_string(bag.seed);
    if (format == "mcap")
      return folder_.file(name + ".mcap", mcap_bytes(bag.messages(RosEncoding::Cdr),
                                                     {.compression = "lz4", .per_chunk = 500}));
    return folder_.file(name + ".bag", bag_bytes(bag.messages(RosEncoding::Ros1), "none", 500));
  }

  ProcessResult calibrate(const RobotBag& bag, const std::string& format, int drives,
                          const std::vector<std::string>& options = {}) {
    std::vector<std::string> words{"calibrate"};
    for (int k = 1; k <= drives; ++k) {
      RobotBag one = bag;
      one.seed = static_cast<unsigned>(k);
      words.push_back(write(one, format));
    }
    words.insert(words.end(),
                 {"--nominal=b=0.4,r=0.05", "--overwrite", "--out=" + (folder_ / "out").string()});
    words.insert(words.end(), options.begin(), options.end());
    return run_bench(words);
  }

  json run_record() const {
    json found;
    for (const std::string& line : lines(content(folder_ / "out/results/runs.jsonl")))
      if (json record = json::parse(line); record.at("kind") == "run") found = record;
    return found;
  }

  // The truth lies in the interval, which is not wider than `most` (relative).
  static void expect_within(const json& record, const std::string& name, double truth, double most) {
    for (const json& p : record.at("trust").at("parameters")) {
      if (p.at("name") != name) continue;
      ASSERT_TRUE(p.at("half_width").is_number()) << p.dump();
      EXPECT_NEAR(p.at("value").get<double>(), truth, p.at("half_width").get<double>()) << name;
      EXPECT_LT(p.at("half_width").get<double>(), most * truth) << name;
      return;
    }
    ADD_FAILURE() << "no interval of " << name;
  }

  TemporaryFolder folder_;
};

class CameraOdometry : public OwnReferences, public ::testing::WithParamInterface<const char*> {};

TEST_P(CameraOdometry, GivesTheRobotWithinItsIntervals) {
  const ProcessResult run = calibrate({}, GetParam(), 6);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("/rtabmap/odom: another odometry, by its name: it drifts"));
  EXPECT_THAT(run.err, HasSubstr("/odom: the robot's own odometry is no reference"));
  EXPECT_THAT(run.err, HasSubstr("the reference drifts: --cost=segments"));
  EXPECT_THAT(run.err, HasSubstr("start: censi"));
  const json record = run_record();
  expect_within(record, "b", RobotBag::kTrack, 0.005);
  expect_within(record, "r_left", RobotBag::kLeft, 0.006);
  expect_within(record, "r_right", RobotBag::kRight, 0.006);
  // "the tracked frame sits at x = 349.80 mm, y = 59.95 mm, yaw = 148.99 deg"
  const RobotBag truth;
  const auto number_behind = [&](const std::string& text) {
    const std::size_t at = run.err.find(text);
    return at == std::string::npos ? 0 : std::stod(run.err.substr(at + text.size()));
  };
  EXPECT_NEAR(number_behind("sits at x = "), 1e3 * truth.mount_x, 2);
  EXPECT_NEAR(number_behind("mm, y = "), 1e3 * truth.mount_y, 2);
  EXPECT_NEAR(number_behind("mm, yaw = "), truth.mount_yaw * 180 / 3.14159265358979, 0.3);
  EXPECT_NEAR(number_behind("clock of odom runs "), truth.clock_ahead_s, 0.005);
  // The set says so itself: whoever calibrates it again compares segments, too.
  const json set = json::parse(content(folder_ / "out/set.json"));
  EXPECT_EQ(set.at("reference"), "drifting");
  const ProcessResult again = run_bench({"--solver=lm", "--data=" + (folder_ / "out/set.json").string()});
  EXPECT_THAT(again.err, HasSubstr("the reference drifts: --cost=segments"));
}

INSTANTIATE_TEST_SUITE_P(Formats, CameraOdometry, ::testing::Values("mcap", "bag"),
                         [](const auto& test) { return std::string(test.param); });

TEST_F(OwnReferences, WheelsAndGyroOutvoteAMirroredFrame) {
  RobotBag bag;
  bag.z_down = true;
  const ProcessResult run = calibrate(bag, "mcap", 1);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("the reference turns against gyro and wheels"));
  EXPECT_THAT(run.err, Not(HasSubstr("exchanged")));
  for (const json& p : run_record().at("parameters")) {
    const double truth = p.at("name") == "b"        ? RobotBag::kTrack
                         : p.at("name") == "r_left" ? RobotBag::kLeft
                                                    : RobotBag::kRight;
    EXPECT_NEAR(p.at("value").get<double>(), truth, 0.01 * truth);
  }
}

TEST_F(OwnReferences, AGyroAloneTellsRatios) {
  RobotBag bag;
  bag.vision = false;
  const ProcessResult run = calibrate(bag, "mcap", 6);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("reference: the gyro, for want of poses"));
  EXPECT_THAT(run.out, HasSubstr("Ratios only: headings tell no length. r_right, held at its nominal value"));
  EXPECT_THAT(run.out, Not(HasSubstr("path factor")));
  const json record = run_record();
  // r_right is held at 50 mm; all others are by it.
  const double factor = 0.05 / RobotBag::kRight;
  expect_within(record, "b", factor * RobotBag::kTrack, 0.001);
  expect_within(record, "r_left", factor * RobotBag::kLeft, 0.001);
  EXPECT_EQ(record.at("trust").at("ratios_only"), true);
  for (const json& d : record.at("trust").at("drives")) EXPECT_EQ(d.at("unit"), "rad");
  const json set = json::parse(content(folder_ / "out/set.json"));
  EXPECT_EQ(set.at("reference"), "headings");
  EXPECT_THAT(set.at("notes").dump(), HasSubstr("0.0040"));  // the bias
  const ProcessResult classical = run_bench({"--solver=lm", "--classical=censi,antonelli", "--format=json",
                                             "--data=" + (folder_ / "out/set.json").string()});
  EXPECT_EQ(classical.exit_code, 0) << classical.err;
  EXPECT_THAT(classical.out, HasSubstr("the reference has headings and no positions"));
  // What asks for positions is refused.
  const ProcessResult mount =
      run_bench({"--solver=lm", "--mount", "--data=" + (folder_ / "out/set.json").string()});
  EXPECT_EQ(mount.exit_code, 2);
  EXPECT_THAT(mount.err, HasSubstr("the reference is a gyro's headings"));
}

TEST_F(OwnReferences, AGyroThatHangsUpsideDownIsTurnedRound) {
  RobotBag bag;
  bag.vision = false;
  bag.gyro_sign = -1;
  const ProcessResult run = calibrate(bag, "bag", 1);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("hang upside down"));
  EXPECT_EQ(json::parse(content(folder_ / "out/map.json"))["signals"]["gyro.z"]["sign"], -1);
  for (const json& p : run_record().at("parameters")) {
    if (p.at("name") != "b") continue;
    EXPECT_NEAR(p.at("value").get<double>(), RobotBag::kTrack * 0.05 / RobotBag::kRight, 1e-3);
  }
}

TEST_F(OwnReferences, WhatAMapMayNotSayOfAGyro) {
  RobotBag bag;
  bag.vision = false;
  ASSERT_EQ(calibrate(bag, "mcap", 1).exit_code, 0);
  const json good = json::parse(content(folder_ / "out/map.json"));
  const auto refused = [&](const json& map, const std::string& expected) {
    const ProcessResult run = run_bench({"import", (folder_ / "drive_1.mcap").string(),
                                         "--map=" + folder_.file("map.json", map.dump()),
                                         "--out=" + (folder_ / "no.json").string()});
    EXPECT_EQ(run.exit_code, 3);
    EXPECT_THAT(run.err, HasSubstr(expected));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "no.json"));
  };
  json map = good;
  map["mount"] = "estimate";
  refused(map, "/mount: found a mount");
  map = good;
  map["reference"] = "drifting";
  refused(map, "/reference: found \"drifting\"");
  map = good;
  map["signals"].erase("gyro.z");
  refused(map, "or gyro.z for its turns alone");
}

}  // namespace
}  // namespace odobench::testing
