// From CSV files to the parameters of a robot, as a user types it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/files.hpp"
#include "datasets/dataset.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/run_process.hpp"
#include "tests/support/shared_data.hpp"

namespace odobench::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// The map that the program proposes, filled in by hand.
json filled_in(const std::string& from) {
  const ProcessResult proposed = run_bench({"import", "csv", "--from=" + from, "--propose"});
  EXPECT_EQ(proposed.exit_code, 0) << proposed.err;
  EXPECT_THAT(proposed.err, HasSubstr("robot: differential"));
  json map = json::parse(proposed.out);
  for (json& p : map["robot"]["parameters"]) p["nominal"] = p["name"] == "b" ? 0.3 : 0.05;
  return map;
}

TEST(CliImportCsv, TheCasesParametersComeOut) {
  ODOBENCH_NEEDS_SHARED();
  const std::string files = (shared_folder() / "cases/differential_drive").string();
  const TemporaryFolder folder;
  json map = filled_in(files);
  map["robot"]["integration"] = "euler";  // how these files were made
  const std::string set = (folder / "set.json").string();
  const ProcessResult imported = run_bench(
      {"import", "csv",
       "--from=" + files + "/ahead.csv," + files + "/left.csv," + files + "/right.csv," + files + "/spin.csv",
       "--map=" + folder.file("map.json", map.dump()), "--out=" + set});
  ASSERT_EQ(imported.exit_code, 0) << imported.err;
  EXPECT_THAT(imported.err, HasSubstr("spin_1 (spin.csv): 240 samples, 11.95 s, 0.00 m, 276."));
  EXPECT_THAT(imported.err, HasSubstr("4 recordings, 800 samples"));
  const ProcessResult solved = run_bench({"--solver=lm", "--data=" + set, "--quiet", "--json"});
  ASSERT_EQ(solved.exit_code, 0) << solved.err;
  const json tables = json::parse(solved.out)["tables"];
  const auto found =
      std::find_if(tables.begin(), tables.end(), [](const json& t) { return t["id"] == "parameters"; });
  ASSERT_NE(found, tables.end());
  const json& best = (*found)["rows"].back();
  ASSERT_EQ(best["parameters"], "lm");
  EXPECT_NEAR(best["r_left"].get<double>(), 50.5, 0.1) << best;
  EXPECT_NEAR(best["r_right"].get<double>(), 49.3, 0.1);
  EXPECT_NEAR(best["b"].get<double>(), 310.0, 0.1);
}

const std::string kDrive =
    "time_s,x_m,y_m,theta_rad,left_rad_s,right_rad_s\n0,0,0,0,2,2\n0.05,0.005,0,0,2,2\n0.1,0.01,0,0,2,2\n";

TEST(CliImportCsv, AProposalIsFilledInAndImported) {
  const TemporaryFolder folder;
  const std::string file = folder.file("ahead_3.csv", kDrive), set = (folder / "set.json").string();
  const std::string map = folder.file("map.json", filled_in(file).dump());
  const ProcessResult r = run_bench(
      {"import", "csv", "--from=" + folder.path().string(), "--map=" + map, "--out=" + set, "--json"});
  ASSERT_EQ(r.exit_code, 0) << r.err;
  EXPECT_THAT(r.err, HasSubstr("ahead_3 (ahead_3.csv): 3 samples, 0.10 s, 0.01 m"));
  EXPECT_THAT(r.out, HasSubstr("\"id\": \"written\""));
  EXPECT_EQ(load_dataset(set).recordings.at(0).repetition, 3);
  const ProcessResult quiet = run_bench(
      {"import", "csv", "--from=" + file, "--map=" + map, "--out=" + set, "--overwrite", "--quiet"});
  EXPECT_EQ(quiet.exit_code, 0);
  EXPECT_THAT(quiet.err, ::testing::Not(HasSubstr("samples, ")));
}

TEST(CliImportCsv, SaysWhatIsMissingOrWrong) {
  const TemporaryFolder folder;
  const std::string from = "--from=" + folder.file("ahead.csv", kDrive),
                    out = "--out=" + (folder / "set.json").string();
  const std::string map =
      "--map=" + folder.file("map.json", filled_in((folder / "ahead.csv").string()).dump());
  expect_refusal({"import", "csv", from, out}, kUsage, {"needs --map=MAP.JSON", "--propose"});
  expect_refusal({"import", "csv", from, map}, kUsage, {"--out"});
  expect_refusal({"import", "csv", from, map, "--propose"}, kUsage, {"leave out --map"});
  expect_refusal({"import", "csv", from, out, "--propose"}, kUsage, {"leave out --out"});
  expect_refusal({"import", "csv", from, map, out, "--exclude=1"}, kUsage, {"--exclude is of optiodom only"});
  expect_refusal({"import", "csv", from, map, out, "--drop-lost"}, kUsage,
                 {"--drop-lost is of vitko2024 only"});
  expect_refusal({"import", "optiodom", from, map, out}, kUsage, {"--map is of csv only"});
  expect_refusal({"import", "vitko2024", from, "--propose"}, kUsage, {"--propose is of csv only"});
  expect_refusal({"import", "vitko2024", from}, kUsage, {"--out"});
  expect_refusal({"import", "csv", from + "," + (folder / "ahead.csv").string(), map, out}, kUsage,
                 {"is given twice"});
  expect_refusal({"import", "csv", "--from=" + (folder / "absent.csv").string(), map, out}, kData,
                 {"absent.csv: cannot be read"});
  expect_refusal({"import", "csv", from, "--map=" + (folder / "absent.json").string(), out}, kData,
                 {"absent.json: cannot be read"});
  folder.file("ahead.csv", kDrive.substr(0, 60) + "nonsense\n");
  expect_refusal({"import", "csv", from, map, out}, kData, {"ahead.csv:3"});
  EXPECT_FALSE(std::filesystem::exists(folder / "set.json"));
}

}  // namespace
}  // namespace odobench::testing
