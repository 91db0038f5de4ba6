// `bench evaluate --tracks`: the paths are those of the direct form, complete and readable.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "datasets/dataset.hpp"
#include "problems/calibration/calibration_problem.hpp"
#include "tests/support/run_process.hpp"
#include "tests/support/source_dir.hpp"

namespace odobench::testing {
namespace {

const std::string kDemoSet = source_dir().string() + "/datasets/demo/set.json";

std::vector<std::string> fields(const std::string& line) {
  std::vector<std::string> list;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) list.push_back(field);
  return list;
}

TEST(Tracks, AreThoseOfTheDirectForm) {
  const TemporaryFolder folder;
  const std::string file = folder / "tracks.csv";
  const ProcessResult run = run_bench({"evaluate", "--parameters=nominal,truth", "--tracks=" + file});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::vector<std::string> rows = lines(content(file));
  ASSERT_FALSE(rows.empty());
  EXPECT_EQ(rows[0], "recording,parameters,time_s,x,y,theta,x_ref,y_ref,theta_ref");

  const Dataset set = load_dataset(kDemoSet);
  Vector nominal(kCalibrationParameters);
  for (Eigen::Index i = 0; i < nominal.size(); ++i)
    nominal[i] = set.robot.parameters[static_cast<std::size_t>(i)].nominal;
  const auto& values = set.known_parameters.at(0).values;
  const Vector truth = Eigen::Map<const Vector>(values.data(), static_cast<Eigen::Index>(values.size()));

  std::size_t row = 1;
  for (const Recording& r : set.recordings)
    for (const auto& [label, z] : {std::pair("nominal", nominal), std::pair("truth", truth)}) {
      const PoseTrack track = direct::integrate(r, z);
      ASSERT_LE(row + r.size(), rows.size());
      for (std::size_t k = 0; k < r.size(); ++k, ++row) {
        const std::vector<std::string> cells = fields(rows[row]);
        ASSERT_EQ(cells.size(), 9u) << rows[row];
        EXPECT_EQ(cells[0], r.id);
        EXPECT_EQ(cells[1], label);
        EXPECT_DOUBLE_EQ(std::stod(cells[2]), static_cast<double>(r.time_us[k]) * 1e-6);
        EXPECT_NEAR(std::stod(cells[3]), track.x[k], 1e-10);
        EXPECT_NEAR(std::stod(cells[4]), track.y[k], 1e-10);
        EXPECT_NEAR(std::stod(cells[5]), track.theta[k], 1e-10);
        EXPECT_EQ(std::stod(cells[6]), r.reference.x[k]);
        EXPECT_EQ(std::stod(cells[7]), r.reference.y[k]);
        EXPECT_EQ(std::stod(cells[8]), r.reference.theta[k]);
      }
    }
  EXPECT_EQ(row, rows.size());
}

TEST(Tracks, DoNotReplaceAFileUnasked) {
  const TemporaryFolder folder;
  const std::string file = folder.file("tracks.csv", "mine\n");
  const ProcessResult refused = run_bench({"evaluate", "--tracks=" + file});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_EQ(refused.out, "");
  EXPECT_NE(refused.err.find("--overwrite"), std::string::npos) << refused.err;
  EXPECT_EQ(content(file), "mine\n");
  EXPECT_EQ(run_bench({"evaluate", "--tracks=" + file, "--overwrite"}).exit_code, 0);
  EXPECT_EQ(content(file).rfind("recording,", 0), 0u);
}

TEST(Tracks, SayWhenTheyCannotBeWritten) {
  const TemporaryFolder folder;
  const std::string blocked = folder.file("file", "");
  const ProcessResult run = run_bench({"evaluate", "--tracks=" + blocked + "/tracks.csv"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_EQ(lines(run.err).size(), 1u) << run.err;
}

TEST(Tracks, QuoteLabelsWithCommas) {
  const TemporaryFolder folder;
  const std::string parameters = folder.file(
      "mine.json", R"({"name": "mine, first", "a1": 0.1125, "a2": -0.1125, "a3": -0.1125, "a4": 0.1125,
        "b1": 0.1125, "b2": 0.1125, "b3": -0.1125, "b4": -0.1125,
        "r1": 0.0254, "r2": 0.0254, "r3": 0.0254, "r4": 0.0254})");
  const std::string file = folder / "tracks.csv";
  ASSERT_EQ(run_bench({"evaluate", "--parameters=" + parameters, "--tracks=" + file}).exit_code, 0);
  EXPECT_EQ(lines(content(file)).at(1).rfind("line_x_1,\"mine, first\",0,", 0), 0u)
      << lines(content(file)).at(1);
}

}  // namespace
}  // namespace odobench::testing
