// `bench filter`, `fuse` on logs as people have them: units that their names do not say, stamps of arrival,
// rows lost, sensors of their own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

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

}  // namespace
}  // namespace odobench::testing
