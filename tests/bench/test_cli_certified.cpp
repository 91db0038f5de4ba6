// Certified problems on the command line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "reports/records/record.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/run_process.hpp"

namespace odobench {
namespace {

using testing::expect_refusal;
using ::testing::HasSubstr;
using testing::kUsage;
using testing::ProcessResult;
using testing::run_bench;

TEST(CliCertified, SolversRunOnThem) {
  const ProcessResult nist = run_bench({"--problem=nist:Misra1a/1", "--solver=lm"});
  EXPECT_EQ(nist.exit_code, 0) << nist.err;
  EXPECT_THAT(nist.out, HasSubstr("0.1245513889"));
  const ProcessResult mgh = run_bench({"--problem=mgh:penalty-1/10", "--solver=lm,ceres", "--dimension=4"});
  EXPECT_EQ(mgh.exit_code, 0) << mgh.err;
  EXPECT_THAT(mgh.out, HasSubstr("2.2499775"));
}

// The data lie in the program, not beside it.
TEST(CliCertified, TheListKnowsThem) {
  const ProcessResult list = run_bench({"list", "problems"});
  EXPECT_EQ(list.exit_code, 0) << list.err;
  for (const char* name : {"nist:Lanczos1/2", "nist:Thurber/1", "mgh:brown-dennis", "mgh:watson/100"})
    EXPECT_THAT(list.out, HasSubstr(name));
}

TEST(CliCertified, WrongNamesAndDimensionsAreRefused) {
  expect_refusal({"--problem=nist:Misra1a/1", "--dimension=3", "--solver=lm"}, kUsage,
                 {"nist:Misra1a/1", "dimension 3; expected 2"});
  expect_refusal({"--problem=nist:misra1a/1", "--solver=lm"}, kUsage, {"did you mean 'nist:Misra1a/1'?"});
  expect_refusal({"--problem=mgh:extended-rosenbrock", "--dimension=7", "--solver=lm"}, kUsage,
                 {"expected 2, 4, 6, ..."});
}

nlohmann::json json_of(const ProcessResult& result) {
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return nlohmann::json::parse(result.out);
}

const nlohmann::json& table_of(const nlohmann::json& document, const std::string& id) {
  for (const auto& table : document.at("tables"))
    if (table.at("id") == id) return table;
  throw std::runtime_error("no table " + id);
}

TEST(CliCertified, ListsAndPatternsEndInOneSummary) {
  const auto document =
      json_of(run_bench({"--problem=nist:Misra1?/*", "--problem=mgh:beale,mgh:freudenstein-roth",
                         "--solver=lm,ceres", "--json"}));
  const auto& rows = table_of(document, "problems_summary").at("rows");
  ASSERT_EQ(rows.size(), 4u);
  for (const auto& row : rows) {
    EXPECT_EQ(row.at("false_verdicts"), 0);
    EXPECT_EQ(row.at("problems"), row.at("family") == "nist" ? 8 : 2);
    EXPECT_EQ(row.at("solved"), row.at("family") == "nist" ? 8 : 1);
    if (row.at("solver") == "ceres") {
      EXPECT_EQ(row.at("converged_elsewhere"), row.at("family") == "nist" ? 0 : 1);
    }
    if (row.at("family") == "nist") {
      EXPECT_GE(row.at("digits_min"), 6);
    }
  }
  const auto& unsolved = table_of(document, "problems_unsolved").at("rows");
  ASSERT_EQ(unsolved.size(), 2u);
  EXPECT_EQ(unsolved[0].at("problem"), "mgh:freudenstein-roth");
  EXPECT_NEAR(unsolved[0].at("cost"), 48.984254, 1e-5);
  EXPECT_EQ(table_of(document, "nist:Misra1d/2.solvers").at("rows").size(), 2u);
}

TEST(CliCertified, RecordsKeepTheKnownAnswerAndASecondOpinion) {
  const testing::TemporaryFolder folder;
  const std::string out = (folder.path() / "runs").string();
  const ProcessResult run = run_bench(
      {"--problem=rosenbrock,powell", "--solver=lm,pso", "--repeat=2", "--out=" + out, "--max-evals=3000"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const auto records = read_records(out + "/runs.jsonl");
  ASSERT_EQ(records.size(), 6u);
  for (const RunRecord& r : records) {
    ASSERT_TRUE(r.known) << r.label;
    EXPECT_EQ(r.known->cost, 0);
    EXPECT_EQ(r.known->solved, *r.cost <= 1e-12) << r.label << " " << *r.cost;
    EXPECT_FALSE(false_verdict(r));
    EXPECT_EQ(r.random, r.solver == "pso");
    EXPECT_EQ(r.box.size(), 16u);
  }
  EXPECT_NE(records.front().box, records.back().box);
}

// The gap is one to the known optimum, also where that is zero.
TEST(CliCertified, TheGapIsToTheKnownOptimum) {
  const auto document = json_of(run_bench({"--problem=mgh:freudenstein-roth", "--solver=lm", "--json"}));
  const auto& table = document.at("tables").at(0);
  EXPECT_EQ(table.at("columns").at(3).at("name"), "gap to optimum");
  EXPECT_NEAR(table.at("rows").at(0).at("gap"), 48.984254, 1e-5);
  const auto relative =
      json_of(run_bench({"--problem=nist:MGH10/1", "--solver=lm", "--json", "--max-evals=5"}));
  const auto& row = relative.at("tables").at(0).at("rows").at(0);
  EXPECT_NEAR(row.at("gap").get<double>(), row.at("cost").get<double>() / 87.945855170396 - 1,
              1e-9 * row.at("gap").get<double>());
}

// Another dimension is another problem: in its name, and so in seeds and in what is compared.
TEST(CliCertified, TheDimensionBelongsToTheName) {
  const auto document =
      json_of(run_bench({"--problem=rosenbrock,sphere", "--dimension=5", "--solver=lm", "--json"}));
  EXPECT_NO_THROW(table_of(document, "rosenbrock[n=5].solvers"));
  const ProcessResult pattern = run_bench({"--problem=mgh:*[!0]", "--dimension=5", "--solver=lm", "--json"});
  EXPECT_THAT(pattern.err, HasSubstr("do not take dimension 5 and are left out"));
  EXPECT_NO_THROW(table_of(json_of(pattern), "mgh:penalty-1[n=5].solvers"));
}

TEST(CliCertified, PatternsThatMeetNothingAreRefused) {
  expect_refusal({"--problem=nist:Q*", "--solver=lm"}, kUsage, {"no problem is called 'nist:Q*'"});
  expect_refusal({"--problem=mgh:beale*", "--dimension=9", "--solver=lm"}, kUsage, {"takes dimension 9"});
  expect_refusal({"--problem=nist:Misra1a/1,", "--solver=lm"}, kUsage, {"unknown problem ''"});
  expect_refusal({"--problem=nist:*", "--data=set.json", "--solver=lm"}, kUsage,
                 {"--data", "takes no data set"});
}

TEST(CliCertified, DerivativesAreCheckedBeforeTheRun) {
  const auto document = json_of(run_bench({"--problem=mgh:beale,rastrigin,step", "--solver=lm,pso",
                                           "--max-evals=200", "--check-derivatives", "--json"}));
  const auto& table = document.at("tables").at(0);
  EXPECT_EQ(table.at("id"), "derivatives");
  // Two parameters by Jacobian and gradient, twelve by gradient, none.
  EXPECT_EQ(table.at("rows").size(), 16u);
  for (const auto& row : table.at("rows")) EXPECT_EQ(row.at("verdict"), "agrees") << row;
  EXPECT_EQ(table.at("notes").at(0), "step: it has no derivatives.");
  EXPECT_THAT(table.at("notes").at(1).get<std::string>(), HasSubstr("0 of 16 derivatives disagree"));
}

// The start of jennrich-sampson/100 overflows.
TEST(CliCertified, WhatCannotBeCheckedIsSaid) {
  const ProcessResult run = run_bench({"--problem=mgh:jennrich-sampson/100", "--solver=pso",
                                       "--max-evals=200", "--check-derivatives", "--json"});
  EXPECT_THAT(run.out, HasSubstr("points the cost is not finite"));
}

}  // namespace
}  // namespace odobench
