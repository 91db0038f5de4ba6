// Suites and statistics of optimisers as a user meets them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "tests/support/run_process.hpp"

namespace odobench {
namespace {

using testing::bench_program;
using ::testing::HasSubstr;
using testing::Process;
using testing::ProcessResult;
using testing::TemporaryFolder;

ProcessResult bench(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), bench_program());
  return Process(arguments).wait();
}

std::set<std::string> table_ids(const std::string& json) {
  std::set<std::string> ids;
  const nlohmann::json tables = nlohmann::json::parse(json);
  for (const auto& table : tables.at("tables")) ids.insert(table.at("id"));
  return ids;
}

TEST(CliSuites, RunAndReport) {
  const TemporaryFolder folder;
  const std::string out = (folder / "runs").string(), page = (folder / "page.html").string();
  const ProcessResult run = bench({"--problem=bbob:f1[n=2,instance=1..2],bbob:f2[n=2],bbob:f8[n=2]",
                                   "--solver=nlopt:lbfgs,nlopt:bobyqa", "--start=random", "--repeat=2",
                                   "--max-evals=500", "--out=" + out, "--format=json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(table_ids(run.out).count("ert"), 0u);  // of reports only
  const ProcessResult report = bench({"report", out, "--format=json"});
  ASSERT_EQ(report.exit_code, 0) << report.err;
  const std::set<std::string> ids = table_ids(report.out);
  for (const char* id : {"ert", "profiles", "ranks", "rank_pairs"}) EXPECT_EQ(ids.count(id), 1u) << id;
  const ProcessResult drawn = bench({"report", out, "--out=" + page});
  EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
}

TEST(CliSuites, Lists) {
  const ProcessResult list = bench({"list", "suites", "--format=json"});
  ASSERT_EQ(list.exit_code, 0) << list.err;
  const nlohmann::json tables = nlohmann::json::parse(list.out).at("tables");
  std::size_t problems = 0;
  for (const auto& row : tables.at(0).at("rows")) problems += row.at("problems").get<std::size_t>();
  std::size_t listed = 0;
  for (std::size_t k = 1; k < tables.size(); ++k)
    for (const auto& row : tables.at(k).at("rows")) {
      EXPECT_TRUE(row.at("start").is_string() && row.at("optimum").is_string() && row.at("hard").is_string())
          << row;
      ++listed;
    }
  EXPECT_EQ(listed, problems);
  EXPECT_GE(listed, 24u + 53u + 54u + 105u);
}

TEST(CliSuites, BadOptionsAreUsageErrors) {
  const ProcessResult run = bench({"--problem=bbob:f1[dim=5]", "--solver=lm"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err,
              HasSubstr("--problem: 'bbob:f1[dim=5]': unknown option 'dim', expected n or instance"));
}

}  // namespace
}  // namespace odobench
