// `--model` and `bench models` on the command line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "datasets/dataset.hpp"
#include "problems/simulation/demo_generator.hpp"
#include "tests/support/run_process.hpp"

namespace odobench {
namespace {

using ::testing::HasSubstr;
using testing::ProcessResult;
using testing::run_bench;

// The demo set with less in it: two repetitions of three trajectories.
std::filesystem::path small_demo(const std::vector<std::string>& model = {}) {
  Dataset set = make_demo_dataset();
  std::vector<Recording> kept;
  for (Recording& r : set.recordings)
    if (r.repetition <= 2 && r.trajectory != "line_x" && r.trajectory != "circle_cw") kept.push_back(r);
  set.recordings = kept;
  set.robot.model = model;
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() /
      ("odobench_models_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  save_dataset(set, folder / "set.json", true);
  return folder;
}

TEST(CliModels, ComparesModelsAndKeepsThem) {
  const std::filesystem::path folder = small_demo();
  const std::string data = "--data=" + (folder / "set.json").string(), out = (folder / "out").string();
  const ProcessResult result = run_bench({"models", data, "--models=plain,least_squares+contact_offset",
                                          "--out=" + out, "--format=json", "--quiet"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json tables = nlohmann::json::parse(result.out);
  const nlohmann::json& rows = tables["tables"][0]["rows"];
  ASSERT_EQ(tables["tables"][0]["id"], "models");
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0]["model"], "nominal");
  for (std::size_t i = 1; i < rows.size(); ++i) {
    EXPECT_LT(rows[i]["cost"].get<double>(), rows[0]["cost"].get<double>());
    EXPECT_TRUE(rows[i].contains("held_total"));
    EXPECT_TRUE(rows[i].contains("new_kind_total"));
  }
  for (const char* format : {"console", "md", "csv", "latex"}) {
    const ProcessResult again = run_bench({"report", out, std::string("--format=") + format});
    EXPECT_EQ(again.exit_code, 0) << again.err;
    EXPECT_THAT(again.out, HasSubstr(std::string(format) == "latex" ? "contact\\_offset" : "contact_offset"));
  }
}

TEST(CliModels, AModelIsNamedWhereverJIs) {
  const std::filesystem::path folder = small_demo({"contact_offset", "no_steering_rate"});
  const std::string data = "--data=" + (folder / "set.json").string();
  const auto problem_of = [&](std::vector<std::string> arguments, const char* out) {
    arguments.push_back(data);
    arguments.push_back("--out=" + (folder / out).string());
    const ProcessResult result = run_bench(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    std::ifstream records(folder / out / "runs.jsonl");
    std::string line;
    std::getline(records, line);
    return nlohmann::json::parse(line);
  };
  EXPECT_EQ(problem_of({"evaluate"}, "own")["problem"],
            "calibration[every_sample,euler,model:contact_offset+no_steering_rate]");
  const nlohmann::json run = problem_of({"run", "--solver=lm", "--model=lever_arm,anchor", "--quiet"}, "run");
  EXPECT_EQ(run["problem"], "calibration[every_sample,euler,model:lever_arm+anchor]");
  EXPECT_EQ(run["parameters"].size(), 14u);
  EXPECT_EQ(problem_of({"evaluate", "--model=none"}, "none")["problem"], "calibration");
}

TEST(CliModels, WrongOnesAreUsageOrData) {
  const std::filesystem::path folder = small_demo({"contact_offsett"});
  const std::string data = "--data=" + (folder / "set.json").string();
  const ProcessResult set = run_bench({"evaluate", data});
  EXPECT_EQ(set.exit_code, 3);
  EXPECT_THAT(set.err, HasSubstr("did you mean 'contact_offset'?"));
  const ProcessResult option = run_bench({"evaluate", data, "--model=steering_zeros,steering_zeros"});
  EXPECT_EQ(option.exit_code, 2);
  EXPECT_THAT(option.err, HasSubstr("named twice"));
  const ProcessResult models = run_bench({"models", data, "--models=nothing"});
  EXPECT_EQ(models.exit_code, 2);
  EXPECT_THAT(models.err, HasSubstr("unknown model 'nothing'"));
}

}  // namespace
}  // namespace odobench
