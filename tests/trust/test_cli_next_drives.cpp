// `plan --between`, and how `calibrate` ends: what explains the errors, what to drive next.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "datasets/dataset.hpp"
#include "tests/support/data/rival_truth.hpp"
#include "tests/support/run_process.hpp"

namespace odobench {
namespace {

using ::testing::HasSubstr;
using testing::ProcessResult;
using testing::run_bench;

constexpr const char* kOffset = "least_squares+contact_offset+no_steering_rate";

// A robot with a contact offset of 6 mm on drives that cannot tell it from slip in turns on the spot.
std::filesystem::path offset_set() {
  const testing::RivalTruth truth =
      testing::rival_truth("4wis4wid", {"least_squares", "contact_offset", "no_steering_rate"}, 0.006);
  Dataset set;
  set.name = "contacts";
  set.robot = truth.robot;
  set.robot.name = "contacts";
  set.description = "a robot with a contact offset";
  set.provenance = {"simulated", "none", "test", {}};
  const std::vector<std::string> drives = {"circle_cw", "circle_ccw", "turn_cw",
                                           "turn_ccw",  "line",       "sideways"};
  for (const std::string& name : drives) set.trajectories.push_back({name, name});
  set.recordings = testing::true_recordings(truth, drives, 4, {}, 2);
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() /
      ("odobench_next_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  save_dataset(set, folder / "set.json", true);
  return folder;
}

// By value: what is within must not outlive it.
nlohmann::json table_of(const nlohmann::json& tables, const std::string& id) {
  for (const nlohmann::json& table : tables["tables"])
    if (table["id"] == id) return table;
  ADD_FAILURE() << "no table " << id;
  return {};
}

TEST(CliNextDrives, PlanDecidesBetweenTwoModelsAndKeepsIt) {
  const std::filesystem::path folder = offset_set();
  const std::string data = "--data=" + (folder / "set.json").string(), out = (folder / "out").string();
  const std::string between = std::string("--between=") + kOffset + ",speed_factor:turn";
  const ProcessResult result =
      run_bench({"plan", data, between, "--out=" + out, "--format=json", "--threads=1"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json table = table_of(nlohmann::json::parse(result.out), "plan.between");
  const nlohmann::json& rows = table["rows"];
  ASSERT_GE(rows.size(), 15u);
  EXPECT_THAT(rows[0]["drive"].get<std::string>(), HasSubstr("circle_0."));
  EXPECT_EQ(rows[0]["repetitions"], 1);
  EXPECT_GT(rows[0]["separation"].get<double>(), 3.29);
  for (const nlohmann::json& row : rows)
    if (row["description"] == "as it was recorded") EXPECT_LT(row["separation"].get<double>(), 3.29) << row;
  const ProcessResult again = run_bench({"report", out, "--format=json"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(table_of(nlohmann::json::parse(again.out), "plan.between"), table);
  const ProcessResult threads = run_bench({"plan", data, between, "--format=json", "--threads=2"});
  EXPECT_EQ(threads.out, result.out);
  // The other way round it is the same with another sign.
  const ProcessResult turned =
      run_bench({"plan", data, "--between=speed_factor:turn," + std::string(kOffset), "--format=json"});
  const nlohmann::json other = table_of(nlohmann::json::parse(turned.out), "plan.between")["rows"];
  EXPECT_EQ(other[0]["drive"], rows[0]["drive"]);
  EXPECT_NEAR(other[0]["heading"].get<double>(), -rows[0]["heading"].get<double>(), 1e-9);
}

TEST(CliNextDrives, PlanRefusesInOneLine) {
  const std::filesystem::path folder = offset_set();
  const std::string data = "--data=" + (folder / "set.json").string();
  const auto refused = [&](std::vector<std::string> arguments, int code, const std::string& text) {
    arguments.insert(arguments.begin(), "plan");
    const ProcessResult result = run_bench(arguments);
    EXPECT_EQ(result.exit_code, code) << result.err;
    EXPECT_THAT(result.err, HasSubstr(text));
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_EQ(result.out.size(), 0u);
  };
  refused({data, "--between=plain"}, 2, "found 1 model, expected two");
  refused({data, "--between=plain,plain"}, 2, "are one model");
  refused({data, "--between=plain,contact_ofset"}, 2, "did you mean 'contact_offset'");
  refused({data, "--between=plain,speed_factor:ride"}, 2, "ride");
  refused({data, "--between=plain,mount", "--candidates=all"}, 2, "--between");
  refused({"--between=plain,mount"}, 2, "neither is given");
  refused({data, "--robot=differential"}, 2, "both are given");
  refused({"--robot=differential", "--between=plain,mount"}, 3, "found no recordings");
}

TEST(CliNextDrives, CalibrateSaysWhatExplainsAndWhatToDrive) {
  const std::filesystem::path folder = offset_set();
  const std::string out = (folder / "out").string();
  const ProcessResult result =
      run_bench({"calibrate", (folder / "set.json").string(), "--out=" + out, "--format=json", "--quiet"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json tables = nlohmann::json::parse(result.out);
  std::map<std::string, nlohmann::json> clauses;
  const nlohmann::json verdict = table_of(tables, "verdict");
  for (const nlohmann::json& row : verdict["rows"]) clauses[row["about"].get<std::string>()] = row;
  ASSERT_TRUE(clauses.count("explains"));
  EXPECT_THAT(clauses["explains"]["sentence"].get<std::string>(), HasSubstr("A contact offset explains"));
  EXPECT_GT(clauses["explains"]["value"].get<double>(), 50);
  ASSERT_TRUE(clauses.count("next"));
  EXPECT_THAT(clauses["next"]["sentence"].get<std::string>(), HasSubstr("circle_0."));
  EXPECT_THAT(clauses["next"]["sentence"].get<std::string>(), HasSubstr("a contact offset and slip"));
  const nlohmann::json drives = table_of(tables, "next_drives")["rows"];
  EXPECT_EQ(clauses["next"]["value"], drives[0]["repetitions"]);
  const nlohmann::json explained = table_of(tables, "explanations")["rows"];
  EXPECT_EQ(explained[0]["parameter"], "offset");
  EXPECT_NEAR(explained[0]["value"].get<double>(), 6, 1.5);  // mm
  // The same in the record, and on the page.
  std::ifstream records(folder / "out" / "results" / "runs.jsonl");
  nlohmann::json run;
  for (std::string line; std::getline(records, line);)
    if (nlohmann::json one = nlohmann::json::parse(line); one["kind"] == "run") run = one;
  EXPECT_EQ(run["trust"]["explanations"].size(), explained.size());
  EXPECT_EQ(run["trust"]["next"]["drives"][0]["drive"], drives[0]["drive"]);
  const ProcessResult report = run_bench({"report", (folder / "out" / "results").string(), "--format=json"});
  EXPECT_EQ(table_of(nlohmann::json::parse(report.out), "next_drives")["rows"], drives);
  std::ifstream page(folder / "out" / "report.html");
  const std::string html((std::istreambuf_iterator<char>(page)), {});
  EXPECT_THAT(html, HasSubstr("A contact offset explains"));
}

TEST(CliNextDrives, CalibrateTakesAModel) {
  const std::filesystem::path folder = offset_set();
  const std::string out = (folder / "out").string(), set = (folder / "set.json").string();
  const ProcessResult result =
      run_bench({"calibrate", set, "--model=least_squares,contact_offset,no_steering_rate", "--out=" + out,
                 "--format=json", "--quiet"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  std::ifstream records(folder / "out" / "results" / "runs.jsonl");
  nlohmann::json run;
  for (std::string line; std::getline(records, line);)
    if (nlohmann::json one = nlohmann::json::parse(line); one["kind"] == "run") run = one;
  EXPECT_THAT(run["problem"].get<std::string>(), HasSubstr("contact_offset"));
  ASSERT_EQ(run["parameters"].back()["name"], "offset");
  EXPECT_NEAR(run["parameters"].back()["value"].get<double>(), 0.006, 1.5e-3);
  const ProcessResult wrong = run_bench({"calibrate", set, "--model=contact_ofset", "--out=" + out + "2"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("did you mean 'contact_offset'"));
  EXPECT_FALSE(std::filesystem::exists(out + "2"));
}

}  // namespace
}  // namespace odobench
