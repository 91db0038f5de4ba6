// What users see of the odometry's noise: tables, parameters/LABEL.json, exports, `bench fuse`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/refusal.hpp"
#include "tests/support/run_process.hpp"
#include "tests/support/source_dir.hpp"

namespace odobench {
namespace {

using testing::content;
using ::testing::HasSubstr;
using testing::ProcessResult;
using testing::run_bench;
using testing::TemporaryFolder;

TEST(CliNoise, GoesFromTheRunToTheController) {
  const TemporaryFolder folder;
  const std::string set = (folder.path() / "set").string(), run = (folder.path() / "run").string();
  ASSERT_EQ(run_bench({"demo", "--robot=differential", "--out=" + set}).exit_code, 0);
  const ProcessResult ran =
      run_bench({"run", "--solver=lm", "--data=" + set + "/set.json", "--out=" + run, "--format=json"});
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("\"noise_kinds\""));
  const nlohmann::json kept = nlohmann::json::parse(content(run + "/parameters/lm.json"));
  const nlohmann::json terms = kept.at("noise").at("terms");
  // Made with 0.2 mm.
  EXPECT_NEAR(std::sqrt(terms.at("capture_position").at("value").get<double>()), 2e-4, 2e-5);
  EXPECT_GT(terms.at("along_per_metre").at("upper").get<double>(), 0);
  const ProcessResult ros2 = run_bench({"export", run, "--to=ros2"});
  EXPECT_THAT(ros2.out, HasSubstr("\n    twist_covariance_diagonal: ["));
  EXPECT_THAT(ros2.out, HasSubstr("alpha5: "));
  EXPECT_THAT(run_bench({"export", run, "--to=yaml"}).out, HasSubstr("\n      heading_per_metre: "));
  EXPECT_THAT(run_bench({"report", run}).out, HasSubstr("Noise of the odometry itself: lm"));
}

TEST(CliNoise, FuseTakesItWhereTheFileSaysNothing) {
  const TemporaryFolder folder;
  nlohmann::json sensors =
      nlohmann::json::parse(content(testing::source_dir() / "datasets/sensors/heading_only.json"));
  const std::string own = folder.file("own.json", sensors.dump());
  sensors.erase("wheels");
  const std::string bare = folder.file("bare.json", sensors.dump());
  const auto fused = [&](const std::string& file, std::vector<std::string> more) {
    more.insert(more.begin(), {"fuse", "--filter=ekf", "--sensors=" + file});
    return run_bench(more);
  };
  const ProcessResult plain = fused(own, {});
  EXPECT_THAT(plain.out, HasSubstr("Wheels in the filter: σ 0.01 m/s and 0.02 rad/s of a sample."));
  EXPECT_EQ(fused(own, {"--odometry-noise=0.01,0.02"}).out, plain.out);
  const ProcessResult total = fused(own, {"--odometry-noise=total"});
  EXPECT_THAT(total.out, HasSubstr("measured on these drives, with what repeats"));
  EXPECT_THAT(fused(bare, {}).out, HasSubstr("measured on these drives, with what repeats"));
  EXPECT_THAT(fused(own, {"--odometry-noise=0.01"}).err, HasSubstr("expected measured, total, file, or two"));
  EXPECT_EQ(fused(own, {"--odometry-noise=0.01"}).exit_code, 2);
  EXPECT_EQ(fused(bare, {"--odometry-noise=file"}).exit_code, 3);
}

}  // namespace
}  // namespace odobench
