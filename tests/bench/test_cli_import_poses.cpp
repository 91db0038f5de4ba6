// End poses by tape measure beside wheel logs: from CSV files to parameters by --cost=final_pose.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "datasets/dataset.hpp"
#include "datasets/import/logs/end_poses.hpp"
#include "tests/support/data_error.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/run_process.hpp"

namespace odobench {
namespace {

using ::testing::HasSubstr;
using testing::kData;
using testing::kUsage;
using testing::ProcessResult;
using testing::run_bench;
using testing::TemporaryFolder;

constexpr double kTrack = 0.31, kRight = 0.051, kLeft = 0.049;  // the truth

class CliImportPoses : public ::testing::Test {
 protected:
  // Half a metre and more on an arc, standing before and after.
  void drive(const std::string& name, double right, double left, double& x, double& y, double& theta) {
    std::string log = "time_s,left,right\n";
    const int steps = 300;
    for (int k = -50; k <= steps + 50; ++k) {
      const double share = std::min(1.0, std::max(0.0, k / static_cast<double>(steps)));
      log += std::to_string(0.02 * (k + 50)) + "," + std::to_string(left * share) + "," +
             std::to_string(right * share) + "\n";
    }
    logs_.push_back(folder_.file(name, log));
    const double length = (kRight * right + kLeft * left) / 2;
    theta = (kRight * right - kLeft * left) / kTrack;
    const double chord = theta == 0 ? length : length * std::sin(theta / 2) / (theta / 2);
    x = chord * std::cos(theta / 2);
    y = chord * std::sin(theta / 2);
  }
  std::string map(const std::string& more = "") {
    return folder_.file("map.json", R"({"schema": "odobench-import", "schema_version": 1, "name": "tape",
      "robot": {"name": "r", "kinematics": "differential"},)" +
                                        more + R"(
      "sources": {"w": {"files": "*.csv", "time": "time_s", "time_unit": "s"}},
      "signals": {"wheel_angle.left": {"field": "left", "unit": "rad"},
                  "wheel_angle.right": {"field": "right", "unit": "rad"}}})");
  }
  std::vector<std::string> import(const std::string& map, const std::string& poses = "") const {
    std::vector<std::string> words{"import"};
    words.insert(words.end(), logs_.begin(), logs_.end());
    words.insert(words.end(), {"--map=" + map, "--overwrite", "--out=" + (folder_ / "set.json").string()});
    if (!poses.empty()) words.push_back("--poses=" + poses);
    return words;
  }
  // Three drives and their poses as a table in mm and degrees.
  std::string table() {
    std::string rows = "drive;x [mm];y [mm];theta_deg\n";
    double x = 0, y = 0, theta = 0;
    const double turns[3][2] = {{30, 30}, {34, 20}, {20, 34}};
    for (int k = 0; k < 3; ++k) {
      const std::string name = "run_" + std::to_string(k + 1);
      drive(name + ".csv", turns[k][0], turns[k][1], x, y, theta);
      rows += name + (k == 0 ? ".csv" : "") + ";" + std::to_string(1e3 * x) + ";" + std::to_string(1e3 * y) +
              ";" + std::to_string(theta * 180 / 3.14159265358979323846) + "\n";
    }
    return rows;
  }
  TemporaryFolder folder_;
  std::vector<std::string> logs_;
};

TEST_F(CliImportPoses, GiveTheRobotThatDrove) {
  folder_.file("poses.txt", table());
  const ProcessResult made = run_bench(import(map(R"("poses": "poses.txt",)")));
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const Dataset set = load_dataset(folder_ / "set.json");
  ASSERT_EQ(set.recordings.size(), 3U);
  for (const Recording& r : set.recordings)
    EXPECT_EQ(r.reference.sample, (std::vector<std::size_t>{0, r.size() - 1}));
  EXPECT_EQ(set.provenance.files.at(1).path, "poses.txt");
  const std::string out = (folder_ / "run").string();
  ASSERT_EQ(run_bench({"--data=" + (folder_ / "set.json").string(), "--solver=lm", "--cost=final_pose",
                       "--quiet", "--out=" + out})
                .exit_code,
            0);
  const auto found = nlohmann::json::parse(testing::content(out + "/parameters/lm.json"))["values"];
  EXPECT_NEAR(found["b"].get<double>(), kTrack, 2e-5);
  EXPECT_NEAR(found["r_right"].get<double>(), kRight, 2e-6);
  EXPECT_NEAR(found["r_left"].get<double>(), kLeft, 2e-6);
}

TEST_F(CliImportPoses, DrivesWithoutOneAreCountedAndPosesWithoutDriveRefused) {
  table();
  const std::string some = folder_.file("some.txt", "id,x,y,yaw [rad]\nrun_2,1.5,0.3,0.4\n");
  const ProcessResult made = run_bench(import(map(), some));
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_THAT(made.err, HasSubstr("2 drives without a pose in some.txt left out: run_1, run_3"));
  const Dataset set = load_dataset(folder_ / "set.json");
  ASSERT_EQ(set.recordings.size(), 1U);
  EXPECT_EQ(set.recordings[0].reference.x, (std::vector<double>{0, 1.5}));
  const std::string other = folder_.file("other.txt", "drive,x,y,theta\nrun_2,1,0,0\nrun_22,1,0,0\n");
  testing::expect_refusal(import(map(), other), kData, {"other.txt:3: no drive 'run_22'", "run_2"});
}

TEST_F(CliImportPoses, WhatNeedsAReferenceIsRefused) {
  folder_.file("poses.txt", table());
  testing::expect_refusal(import(map()), kData, {"/signals", "\"poses\""});
  testing::expect_refusal(import(map(R"("poses": "poses.txt", "mount": {"x": 0.1},)")), kData, {"/mount"});
  testing::expect_refusal(import(map(R"("poses": "none.txt",)")), kData, {"none.txt"});
  testing::expect_refusal(
      {"import", "csv", "--from=" + folder_.path().string(), "--poses=a", "--map=b", "--out=c"}, kUsage,
      {"--poses"});
}

TEST(EndPoses, AreReadInTheUnitsOfTheirHeader) {
  const auto poses =
      log_import::parse_end_poses("heading (deg),y_cm,note,file,x [mm]\n90,-2,windy,a b.csv,1500\n", "t");
  ASSERT_EQ(poses.size(), 1U);
  EXPECT_EQ(poses[0].drive, "a b.csv");
  EXPECT_DOUBLE_EQ(poses[0].x, 1.5);
  EXPECT_DOUBLE_EQ(poses[0].y, -0.02);
  EXPECT_NEAR(poses[0].theta, 1.5707963267948966, 1e-15);
}

TEST(EndPoses, OfNoUseAreRefusedWithTheLine) {
  const auto read = [](const std::string& text) {
    return testing::data_error([&] { log_import::parse_end_poses(text, "t"); });
  };
  EXPECT_THAT(read("x,y,theta\n1,2,3\n"), HasSubstr("t:1: found no column 'drive'"));
  EXPECT_THAT(read("drive,x,y\na,2,3\n"), HasSubstr("t:1: found no column of theta"));
  EXPECT_THAT(read("drive,x,y,theta,yaw\na,1,2,3,4\n"), HasSubstr("t:1: found two columns of theta"));
  EXPECT_THAT(read("drive,x [s],y,theta\na,1,2,3\n"), HasSubstr("expected m, cm or mm"));
  EXPECT_THAT(read("drive,x,y,theta\na,1,2,3\na,1,2,3\n"), HasSubstr("t:3: drive 'a' has a pose in line 2"));
  EXPECT_THAT(read("drive,x,y,theta\na,1,b,3\n"), HasSubstr("t:2"));
  EXPECT_THAT(read("drive,x,y,theta\n"), HasSubstr("found no row"));
}

}  // namespace
}  // namespace odobench
