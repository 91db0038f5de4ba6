// `bench import` with a gyro and a camera in its map, and `bench fuse` on what it keeps of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "datasets/dataset.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/run_process.hpp"

namespace odobench::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

// The thesis' robot stands for 1.5 s, drives 8 s along a circle, and stands again. Wheels and motion capture
// at 50 Hz; a gyro at 100 Hz with a bias; a camera at 20 Hz in a frame of its own, mounted beside the middle,
// without rows for a second, whose clock runs ahead.
struct CameraLogs {
  static constexpr double kBias = 0.03, kTurn = 1.1, kMountX = 0.1, kMountY = 0.05, kMountYaw = 0.2;
  static constexpr double kAhead = 0.4, kCurve = 0.8;  // s; 1/m

  static double way(double t) {  // m, of the middle
    const double u = std::clamp((t - 1.5) / 8, 0.0, 1.0);
    return 2.4 * (u - std::sin(2 * std::acos(-1.0) * u) / (2 * std::acos(-1.0)));
  }
  static std::array<double, 3> pose(double t) {
    const double a = kCurve * way(t);
    return {1 + std::sin(a) / kCurve, 2 + (1 - std::cos(a)) / kCurve, a};
  }
  static std::string wheels() {
    std::string csv = "t,a1,a2,a3,a4,s1,s2,s3,s4\n";
    for (int k = 0; k <= 550; ++k) {
      const double t = 0.02 * k, c = 0.1125;
      std::string angles, steering;
      for (const auto& [x, y] : {std::pair{c, c}, {-c, c}, {-c, -c}, {c, -c}}) {
        const double ux = 1 - kCurve * y, uy = kCurve * x;
        angles += fmt::format(",{}", way(t) * std::hypot(ux, uy) / 0.0254);
        steering += fmt::format(",{}", std::atan2(uy, ux));
      }
      csv += fmt::format("{:.2f}{}{}\n", 500 + t, angles, steering);
    }
    return csv;
  }
  static std::string mocap() {
    std::string csv = "t,x,y,yaw\n";
    for (int k = 0; k <= 550; ++k) {
      const auto p = pose(0.02 * k);
      csv += fmt::format("{:.2f},{},{},{}\n", 500 + 0.02 * k, p[0], p[1], p[2]);
    }
    return csv;
  }
  static std::string imu() {
    std::string csv = "t,gz\n";
    for (int k = 5; k <= 1095; ++k) {
      const double t = 0.01 * k, rate = kCurve * (way(t + 1e-4) - way(t - 1e-4)) / 2e-4;
      csv += fmt::format("{:.2f},{}\n", 500 + t, kBias + rate + 0.002 * std::sin(7.0 * k));
    }
    return csv;
  }
  static std::string camera() {
    std::string csv = "stamp,px,py,heading_deg\n";
    for (int k = 0; k <= 220; ++k) {
      const double t = 0.05 * k;
      if (t > 5 && t < 6) continue;
      const auto p = pose(t);
      const double x = p[0] + kMountX * std::cos(p[2]) - kMountY * std::sin(p[2]),
                   y = p[1] + kMountX * std::sin(p[2]) + kMountY * std::cos(p[2]), c = std::cos(kTurn),
                   s = std::sin(kTurn);
      csv += fmt::format("{:.3f},{},{},{}\n", 500 + kAhead + t, 5 + c * x - s * y, -3 + s * x + c * y,
                         (p[2] + kMountYaw + kTurn) * 180 / std::acos(-1.0));
    }
    return csv;
  }
  static std::string map() {
    std::string parameters, signals;
    const std::array<double, 4> a{0.1125, -0.1125, -0.1125, 0.1125}, b{0.1125, 0.1125, -0.1125, -0.1125};
    for (const char name : {'a', 'b', 'r'})
      for (std::size_t i = 0; i < 4; ++i)
        parameters += fmt::format(R"({{"name": "{}{}", "nominal": {}}},)", name, i + 1,
                                  name == 'a'   ? a[i]
                                  : name == 'b' ? b[i]
                                                : 0.0254);
    for (int i = 1; i <= 4; ++i)
      signals += fmt::format(R"("wheel_angle.{0}": {{"source": "wheels", "field": "a{0}", "unit": "rad"}},
        "steering.{0}": {{"source": "wheels", "field": "s{0}", "unit": "rad"}},)",
                             i);
    parameters.pop_back();
    return fmt::format(R"({{"schema": "odobench-import", "schema_version": 1, "name": "loop",
 "robot": {{"name": "loop", "kinematics": "4wis4wid", "parameters": [{}]}},
 "sources": {{"wheels": {{"files": "wheels.csv", "time": "t"}}, "mocap": {{"files": "mocap.csv", "time": "t"}},
   "imu": {{"files": "imu.csv", "time": "t"}}, "camera": {{"files": "camera.csv", "time": "stamp", "offset_s": {}}}}},
 "signals": {{{} "reference.x": {{"source": "mocap", "field": "x"}}, "reference.y": {{"source": "mocap", "field": "y"}},
   "reference.heading": {{"source": "mocap", "field": "yaw"}}, "gyro.z": {{"source": "imu", "field": "gz"}},
   "camera.x": {{"source": "camera", "field": "px"}}, "camera.y": {{"source": "camera", "field": "py"}},
   "camera.heading": {{"source": "camera", "field": "heading_deg", "unit": "deg"}}}},
 "camera_mount": {{"x": {}, "y": {}, "yaw": {}}}}})",
                       parameters, kAhead, signals, kMountX, kMountY, kMountYaw);
  }
};

class FusionOfLogs : public ::testing::Test {
 protected:
  ProcessResult import_logs(const std::string& map = CameraLogs::map()) const {
    return run_bench({"import", folder_.file("wheels.csv", CameraLogs::wheels()),
                      folder_.file("mocap.csv", CameraLogs::mocap()),
                      folder_.file("imu.csv", CameraLogs::imu()),
                      folder_.file("camera.csv", CameraLogs::camera()),
                      "--map=" + folder_.file("map.json", map), "--out=" + set(), "--overwrite"});
  }
  std::string set() const { return (folder_ / "set.json").string(); }
  std::string sensors() const { return (folder_ / "set_sensors.json").string(); }
  // Rows of numbers, without the header.
  static std::vector<std::vector<double>> table(const std::filesystem::path& file) {
    std::vector<std::vector<double>> rows;
    for (const std::string& line : lines(content(file))) {
      if (line.starts_with("time")) continue;
      std::istringstream in(line);
      rows.emplace_back();
      for (std::string field; std::getline(in, field, ',');) rows.back().push_back(std::stod(field));
    }
    return rows;
  }
  TemporaryFolder folder_;
};

TEST_F(FusionOfLogs, CalibrateKeepsThemAndNamesTheNextCommand) {
  ASSERT_EQ(import_logs().exit_code, 0);  // writes the logs
  std::vector<std::string> words{"calibrate"};
  for (const char* name : {"wheels.csv", "mocap.csv", "imu.csv", "camera.csv"})
    words.push_back((folder_ / name).string());
  words.insert(words.end(),
               {"--map=" + (folder_ / "map.json").string(), "--out=" + (folder_ / "out").string()});
  const ProcessResult run = run_bench(words);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(content(folder_ / "out/set_sensors.json").size(), content(sensors()).size());
  const std::string begin = "next: bench fuse ";
  const std::size_t at = run.err.find(begin);
  ASSERT_NE(at, std::string::npos) << run.err;
  std::istringstream command(run.err.substr(at + begin.size(), run.err.find('\n', at) - at - begin.size()));
  words = {"fuse"};
  for (std::string word; command >> word;) words.push_back(word);
  const ProcessResult fused = run_bench(words);
  EXPECT_EQ(fused.exit_code, 0) << fused.err;
  EXPECT_THAT(fused.out, HasSubstr("lm@results+ekf"));
}

TEST_F(FusionOfLogs, TuneTakesThemToo) {
  ASSERT_EQ(import_logs().exit_code, 0);
  const ProcessResult run = run_bench({"tune", "--data=" + set(), "--sensors=" + sensors(), "--max-evals=40",
                                       "--out=" + (folder_ / "tuned.json").string()});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json given = json::parse(content(sensors())), tuned = json::parse(content(folder_ / "tuned.json"));
  // The camera has no noise: what is believed of it falls; what is read stays.
  const auto camera = [](const json& file) {
    for (const json& s : file.at("sensors"))
      if (s.at("name") == "camera") return s;
    return json();
  };
  EXPECT_LT(camera(tuned)["filter"]["sigma_position"], camera(given)["filter"]["sigma_position"]);
  EXPECT_EQ(camera(tuned)["file"], camera(given)["file"]);
  // Other robots: one line.
  json other = json::parse(content(set()));
  other["robot"]["kinematics"] = "swerve";
  other["robot"].erase("parameters");
  const ProcessResult refused =
      run_bench({"tune", "--data=" + folder_.file("other.json", other.dump()), "--sensors=" + sensors()});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_THAT(refused.err, HasSubstr("expected \"4wis4wid\""));
}

TEST_F(FusionOfLogs, TheSetKeepsTheirMeasurementsByTheRecordingsClock) {
  const ProcessResult imported = import_logs();
  ASSERT_EQ(imported.exit_code, 0) << imported.err;
  EXPECT_THAT(imported.err, HasSubstr("set_sensors.json: the sensors for bench fuse"));
  const Dataset dataset = load_dataset(set());
  ASSERT_EQ(dataset.recordings.size(), 1u);
  const Recording& r = dataset.recordings.front();
  const json file = json::parse(content(sensors()));
  ASSERT_EQ(file.at("sensors").size(), 2u);
  EXPECT_NEAR(file["sensors"][0].at("standing").at(r.id).get<double>(), CameraLogs::kBias, 3e-4);
  const auto camera = table(folder_ / ("set_recordings/camera_" + r.id + ".csv"));
  const auto gyro = table(folder_ / ("set_recordings/gyro_" + r.id + ".csv"));
  EXPECT_GT(gyro.size(), 4 * camera.size());
  // The camera's poses are the robot's, in the reference's frame: turned, shifted and mounted as it was.
  double longest = 0;
  for (std::size_t k = 0; k < camera.size(); ++k) {
    if (k > 0) longest = std::max(longest, camera[k][0] - camera[k - 1][0]);
    std::size_t j = 0;
    while (j + 1 < r.size() && static_cast<double>(r.time_us[j]) < camera[k][0]) ++j;
    if (std::abs(static_cast<double>(r.time_us[j]) - camera[k][0]) > 10) continue;
    EXPECT_NEAR(camera[k][1], r.reference.x[j], 1e-5) << k;
    EXPECT_NEAR(camera[k][2], r.reference.y[j], 1e-5) << k;
    EXPECT_NEAR(std::remainder(camera[k][3] - r.reference.theta[j], 2 * std::acos(-1.0)), 0, 1e-5) << k;
  }
  EXPECT_NEAR(longest, 1e6, 60'000);  // the gap stays one
}

TEST_F(FusionOfLogs, FusingThemFollowsTheRobot) {
  ASSERT_EQ(import_logs().exit_code, 0);
  const ProcessResult run =
      run_bench({"fuse", "--data=" + set(), "--sensors=" + sensors(), "--filter=none,ekf", "--format=json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("Sensors: measured, read from files"));
  EXPECT_THAT(run.out, HasSubstr("less what it said standing"));
  EXPECT_THAT(run.err, Not(HasSubstr("looks like a bias")));
  // With the bias left in, it is seen.
  const std::string text = content(sensors());
  json biased = json::parse(text);
  biased["sensors"][0].erase("standing");
  const ProcessResult warned =
      run_bench({"fuse", "--data=" + set(), "--sensors=" + folder_.file("biased.json", biased.dump()),
                 "--filter=none,ekf"});
  ASSERT_EQ(warned.exit_code, 0) << warned.err;
  EXPECT_THAT(warned.err, HasSubstr("looks like a bias"));
}

TEST_F(FusionOfLogs, HalfACameraIsRefused) {
  const std::string map = CameraLogs::map();
  const std::size_t at = map.find("\"camera.y\""), end = map.find("\"camera.heading\"");
  const ProcessResult result = import_logs(map.substr(0, at) + map.substr(end));
  EXPECT_EQ(result.exit_code, kData);
  EXPECT_THAT(result.err, HasSubstr("lack camera.x, camera.y or camera.heading"));
}

}  // namespace
}  // namespace odobench::testing
