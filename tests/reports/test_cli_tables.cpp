// Which tables are printed: the answer by default, the others on demand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "tests/support/run_process.hpp"

namespace odobench {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::lines;
using ::testing::Not;
using testing::ProcessResult;
using testing::run_bench;

std::set<std::string> tables_of(const std::string& json) {
  std::set<std::string> ids;
  const nlohmann::json parsed = nlohmann::json::parse(json);
  for (const nlohmann::json& table : parsed.at("tables")) ids.insert(table.at("id"));
  return ids;
}

TEST(CliTables, TheAnswerFitsOnOneScreen) {
  const ProcessResult run = run_bench({"--solver=lm,ceres"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_LE(lines(run.out).size(), 25u) << run.out;
  EXPECT_THAT(run.out, AllOf(HasSubstr("Verdict"), HasSubstr("total error -99"), HasSubstr("Methods"),
                             HasSubstr("Parameters of "), HasSubstr(" +- ")));
  EXPECT_THAT(run.out, Not(HasSubstr("Errors on trajectory")));
}

TEST(CliTables, OthersComeWhenTheyAreAskedFor) {
  EXPECT_THAT(run_bench({"--solver=lm", "--tables=all"}).out,
              AllOf(HasSubstr("Errors on trajectory"), HasSubstr("Verdict"), HasSubstr("Solvers")));
  const std::string some = run_bench({"--solver=lm", "--tables=totals,errors"}).out;
  EXPECT_THAT(some, AllOf(HasSubstr("Errors on trajectory"), HasSubstr("Sums"), Not(HasSubstr("Verdict"))));
  const std::set<std::string> json = tables_of(run_bench({"--solver=lm", "--json"}).out);
  EXPECT_EQ(json.count("verdict") + json.count("overview") + json.count("totals") + json.count("solvers"),
            4u);
  const std::set<std::string> two =
      tables_of(run_bench({"--solver=lm", "--json", "--tables=totals,fit"}).out);
  EXPECT_EQ(two, (std::set<std::string>{"fit", "totals"}));
  // Problems without errors have one table that says it all.
  EXPECT_THAT(run_bench({"--solver=lm", "--problem=rosenbrock"}).out, HasSubstr("Solvers"));
}

TEST(CliTables, AnUnknownNameIsToldBesideTheAnswer) {
  const ProcessResult run = run_bench({"--solver=lm", "--tables=total"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("--tables: no table 'total', did you mean 'totals'?; there are verdict,"));
  EXPECT_THAT(run.out, HasSubstr("Verdict")) << "what was worked out is not lost";
  EXPECT_EQ(run_bench({"--solver=lm", "--tables=totals,,fit"}).exit_code, 2);
}

TEST(CliTables, EvaluateAndReportHaveThemToo) {
  EXPECT_THAT(run_bench({"evaluate", "--tables=totals"}).out,
              AllOf(HasSubstr("Sums"), Not(HasSubstr("Cost"))));
  const testing::TemporaryFolder folder;
  const std::string out = (folder / "out").string();
  ASSERT_EQ(run_bench({"--solver=lm", "--out=" + out}).exit_code, 0);
  const ProcessResult key = run_bench({"report", out, "--tables=key"});
  EXPECT_THAT(key.out, AllOf(HasSubstr("Verdict"), Not(HasSubstr("Errors on"))));
  EXPECT_EQ(run_bench({"report", out, "--tables=nothing"}).exit_code, 2);
}

}  // namespace
}  // namespace odobench
