// `bench filter`, `fuse` on logs as people have them: units that their names do not say, stamps of arrival,
// rows lost, sensors of their own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <sstream>

#include "tests/support/data/filter_run_files.hpp"
#include "tests/support/data_error.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/run_process.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/source_dir.hpp"

namespace odobench::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class FilterLogs : public ::testing::Test {
 protected:
  static ProcessResult filter(const std::string& name, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"filter", "--data=" + (shared_folder() / "cases" / name).string()};
    words.insert(words.end(), more.begin(), more.end());
    return run_bench(words);
  }
};

TEST_F(FilterLogs, UnitsThatNamesDoNotSayAreNamed) {
  ODOBENCH_NEEDS_SHARED();
  EXPECT_THAT(filter("filter_wrong_units/encoders_mm.csv").err, HasSubstr("are these millimetres?"));
  EXPECT_THAT(filter("filter_wrong_units/time_milliseconds.csv").err, HasSubstr("are these milliseconds?"));
  const ProcessResult rate = filter("filter_wrong_units/rate_deg_under_rad.csv");
  EXPECT_EQ(rate.exit_code, 0);
  EXPECT_THAT(rate.err, HasSubstr("57.1 times what the wheels say"));
  EXPECT_THAT(filter("filter_csv_dialects/plain.csv").err, Not(HasSubstr("warning")));
}

TEST_F(FilterLogs, StampsOfArrivalJitter) {
  ODOBENCH_NEEDS_SHARED();
  const ProcessResult run = filter("filter_irregular_stamps/jitter_3ms.csv");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("28 steps differ from the period of 0.1003"));
  const ProcessResult strict = filter("filter_irregular_stamps/jitter_3ms.csv", {"--time-tolerance=0.01"});
  EXPECT_EQ(strict.exit_code, 3);
  EXPECT_THAT(strict.err, HasSubstr("--time-tolerance and --dt state them"));
}

TEST_F(FilterLogs, LostRowsAreRefusedOrFilledIn) {
  ODOBENCH_NEEDS_SHARED();
  const ProcessResult refused = filter("filter_irregular_stamps/one_row_lost.csv");
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_THAT(refused.err, HasSubstr("one_row_lost.csv:32: found a time step of 0.2 s, expected 0.1 s"));
  EXPECT_THAT(refused.err, HasSubstr("--resample fills them in"));
  const ProcessResult filled = filter("filter_irregular_stamps/one_row_lost.csv", {"--resample"});
  EXPECT_EQ(filled.exit_code, 0) << filled.err;
  EXPECT_THAT(filled.err, HasSubstr("1 missing rows filled in"));
}

TEST_F(FilterLogs, AGyroBiasThatNobodyEstimatesIsNamed) {
  ODOBENCH_NEEDS_SHARED();
  const ProcessResult run =
      run_bench({"fuse", "--sensors=" + (shared_folder() / "cases/fuse_gyro_bias/sensors.json").string(),
                 "--parameters=truth", "--filter=none,ekf"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("the gate rejects 84 % of camera"));
  EXPECT_THAT(run.err, HasSubstr("\"gyro_bias\": {\"initial\": 0.05"));
  EXPECT_THAT(run.err, HasSubstr("worse than the wheels alone"));
}

TEST_F(FilterLogs, FusionTakesMeasurementsOfFiles) {
  const TemporaryFolder folder;
  const std::string set = (folder / "demo/set.json").string();
  ASSERT_EQ(run_bench({"demo", "--out=" + (folder / "demo").string()}).exit_code, 0);
  std::string csv = "t [ms],gz\n";
  for (int k = 0; k < 3000; ++k) csv += std::to_string(20 * k) + ",0.5\n";
  for (const auto& entry : std::filesystem::directory_iterator(source_dir() / "datasets/demo/set_recordings"))
    folder.file("gyro_" + entry.path().stem().string() + ".csv", csv);
  const auto sensors = [&](const std::string& more) {
    return folder.file(
        "sensors.json",
        R"({"wheels": {"sigma_velocity": 0.01, "sigma_yaw_rate": 0.02}, "sensors": [{"name": "gyro",
      "type": "yaw_rate", "file": "gyro_{recording}.csv", )" +
            more + R"("unit": "deg/s", "filter": {"sigma_yaw_rate": 0.01}}]})");
  };
  const std::string columns = R"("columns": {"time": "t [ms]", "yaw_rate": "gz"}, )";
  const ProcessResult run =
      run_bench({"fuse", "--data=" + set, "--sensors=" + sensors(columns), "--filter=none,ekf"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("Sensors: measured, read from files"));
  EXPECT_THAT(run.out, Not(HasSubstr("SYNTHETIC")));
  const ProcessResult wrong =
      run_bench({"fuse", "--data=" + set,
                 "--sensors=" + sensors(R"("columns": {"time": "t [ms]", "yaw_rate": "gx"}, )")});
  EXPECT_EQ(wrong.exit_code, 3);
  EXPECT_THAT(wrong.err, HasSubstr("did you mean 'gz'"));
}

// A circle at constant speed (CircleRun) as two logs: wheel counters at 50 Hz, an IMU at 200 Hz whose clock
// runs a quarter of a second ahead. Wheels stand in another order than the filter's.
struct CircleLogs {
  int bits = 12;                    // of the counters
  double gap_from = 9, gap_to = 9;  // without IMU
  double imu_scale = 1;             // of its rate
  static constexpr double kRadius[4] = {0.05, 0.06, 0.04, 0.08};

  // Front left, rear left, rear right, front right.
  static std::array<std::array<double, 2>, 4> places(const CircleRun& run) {
    const double a = run.length / 2, b = run.width / 2;
    return {{{a, b}, {-a, b}, {-a, -b}, {a, -b}}};
  }
  std::string wheels(const CircleRun& run) const {
    std::string csv = "t,c1,c2,c3,c4,s1,s2,s3,s4\n";
    for (int k = 0; k <= 250; ++k) {
      const double t = 0.02 * k;
      std::string counts, angles;
      for (std::size_t w = 0; w < 4; ++w) {
        const double x = run.vx - run.omega * places(run)[w][1], y = run.vy + run.omega * places(run)[w][0];
        const double turns = std::hypot(x, y) * t / kRadius[w] / (2 * std::numbers::pi);
        counts += fmt::format(",{}", std::fmod(1e4 * turns, std::exp2(bits)));
        angles += fmt::format(",{}", std::atan2(y, x) * 180 / std::numbers::pi);
      }
      csv += fmt::format("{:.2f}{}{}\n", 1000 + t, counts, angles);
    }
    return csv;
  }
  std::string imu(const CircleRun& run) const {
    std::string csv = "stamp,gz,acc_x,acc_y\n";
    for (int k = 0; k <= 1000; ++k) {
      const double t = 0.005 * k;
      if (t > gap_from && t < gap_to) continue;
      csv += fmt::format("{:.3f},{},{},{}\n", 1000.25 + t, imu_scale * run.omega * 180 / std::numbers::pi,
                         -run.omega * run.vy / 9.80665, run.omega * run.vx / 9.80665);
    }
    return csv;
  }
  std::string map(const CircleRun& run) const {
    std::string parameters, signals;
    for (std::size_t w = 0; w < 4; ++w) {
      const auto p = places(run)[w];
      parameters += fmt::format(
          R"({{"name": "x{0}", "nominal": {1}}}, {{"name": "y{0}", "nominal": {2}}}, {{"name": "r{0}", "nominal": {3}}}, )",
          w + 1, p[0], p[1], kRadius[w]);
      signals += fmt::format(
          R"("wheel_angle.{0}": {{"source": "wheels", "field": "c{0}", "unit": "count", "per_turn": 10000, "bits": {1}}},
             "steering.{0}": {{"source": "wheels", "field": "s{0}", "unit": "deg"}}, )",
          w + 1, bits);
    }
    parameters.resize(parameters.size() - 2);
    return fmt::format(R"({{"schema": "odobench-import", "schema_version": 1, "name": "circle",
 "robot": {{"name": "circle", "kinematics": "swerve", "parameters": [{}]}},
 "sources": {{"wheels": {{"files": "wheels.csv", "time": "t"}}, "imu": {{"files": "imu.csv", "time": "stamp", "offset_s": 0.25}}}},
 "signals": {{{} "gyro.z": {{"source": "imu", "field": "gz", "unit": "deg/s"}},
   "accel.x": {{"source": "imu", "field": "acc_x", "unit": "g"}}, "accel.y": {{"source": "imu", "field": "acc_y", "unit": "g"}}}}}})",
                       parameters, signals);
  }
};

class FilterOfLogs : public ::testing::Test {
 protected:
  std::vector<std::string> words(const CircleLogs& logs, std::vector<std::string> more = {}) const {
    const CircleRun run;
    std::vector<std::string> all{"filter",
                                 "--data=" + folder_.file("wheels.csv", logs.wheels(run)) + "," +
                                     folder_.file("imu.csv", logs.imu(run)),
                                 "--map=" + folder_.file("map.json", logs.map(run)), "--format=json"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  TemporaryFolder folder_;
};

TEST_F(FilterOfLogs, AreWhatTheRobotDid) {
  const CircleRun circle;
  const std::string out = (folder_ / "filtered.csv").string();
  const ProcessResult run = run_bench(words({}, {"--dt=0.1", "--out=" + out}));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("wheel.1: 251 rows, 50.0 Hz"));
  EXPECT_THAT(run.err, HasSubstr("50 rows, one every 0.1 s"));
  const std::vector<std::string> rows = lines(content(out));
  ASSERT_EQ(rows.size(), 42u);
  std::istringstream row(rows[1]);
  std::vector<double> values;
  for (std::string field; std::getline(row, field, ',');)
    values.push_back(field.empty() ? 0 : std::stod(field));
  // The filter's wheels are front right, rear right, rear left, front left.
  const std::size_t order[4] = {3, 2, 1, 0};
  for (std::size_t w = 0; w < 4; ++w) {
    const auto p = CircleLogs::places(circle)[order[w]];
    const double way = std::hypot(circle.vx - circle.omega * p[1], circle.vy + circle.omega * p[0]) * 0.1;
    EXPECT_NEAR(values[1 + w], way, 2e-6) << w;
  }
  EXPECT_NEAR(values[5], 0, 1e-5);
  EXPECT_NEAR(values[6], 0, 1e-5);
  EXPECT_THAT(run.out, HasSubstr("L 0.475164 m"));
  EXPECT_THAT(run.err, Not(HasSubstr("warning")));
}

TEST_F(FilterOfLogs, GapsAndUnitsAreWatchedAsInTables) {
  CircleLogs gap;
  gap.gap_from = 2, gap.gap_to = 2.4;
  expect_refusal(words(gap, {"--dt=0.1"}), kData,
                 {"found no gyro.z from 2.000 to 2.400 s", "max_wheel_gap_s", "--resample"});
  const ProcessResult filled = run_bench(words(gap, {"--dt=0.1", "--resample"}));
  EXPECT_EQ(filled.exit_code, 0) << filled.err;
  EXPECT_THAT(filled.err, HasSubstr("3 rows in gaps filled in"));
  CircleLogs degrees;
  degrees.imu_scale = 180 / std::numbers::pi;
  EXPECT_THAT(run_bench(words(degrees, {"--dt=0.1"})).err, HasSubstr("times what the wheels say"));
}

TEST_F(FilterOfLogs, WhatDoesNotGoWithThemIsSaid) {
  expect_refusal(words({}, {"--columns=enc1_m=a"}), kUsage, {"--columns is of CSV data"});
  const CircleRun run;
  const std::string data = words({})[1];
  const auto with_map = [&](const std::string& from, const std::string& to) {
    return std::vector<std::string>{
        "filter", data, "--map=" + folder_.file("other.json", replaced(CircleLogs().map(run), from, to))};
  };
  expect_refusal(with_map("\"accel.y\"", "\"accel.z\""), kUsage, {"/signals: found no \"accel.y\""});
  expect_refusal(with_map("\"offset_s\": 0.25", "\"offset_s\": \"estimate\""), kUsage,
                 {"/sources/imu/offset_s: found \"estimate\""});
  expect_refusal(with_map("\"x1\", \"nominal\": 0.3875", "\"x1\", \"nominal\": -0.3875"), kUsage,
                 {"found a wheel at (-0.3875, 0.275)", "one in each corner"});
  expect_refusal(with_map("\"acc_x\"", "\"acc_xx\""), kData, {"acc_xx"});
}

}  // namespace
}  // namespace odobench::testing
