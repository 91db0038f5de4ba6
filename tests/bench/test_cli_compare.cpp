// `bench compare` as its users meet it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "reports/records/record.hpp"
#include "tests/support/data/report_records.hpp"
#include "tests/support/run_process.hpp"

namespace odobench {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::ProcessResult;
using testing::run_bench;
using testing::run_record;
using testing::TemporaryFolder;

constexpr int kUsage = 2, kData = 3;

std::string text_of(const std::vector<RunRecord>& records) {
  std::string text;
  for (const RunRecord& r : records) text += to_json_line(r) + "\n";
  return text;
}

std::vector<RunRecord> repeats(const std::string& label, double first, int count = 10) {
  std::vector<RunRecord> records;
  for (int i = 0; i < count; ++i) records.push_back(run_record(label, first + 0.01 * i, i + 1));
  return records;
}

class CliCompare : public ::testing::Test {
 protected:
  std::string file(const std::string& name, const std::vector<RunRecord>& records) const {
    return folder_.file(name, text_of(records));
  }
  TemporaryFolder folder_;
};

TEST_F(CliCompare, NoChange) {
  const std::string runs = file("a.jsonl", repeats("pso", 1));
  const ProcessResult same = run_bench({"compare", runs, runs, "--fail-on=J:+0%,seconds:+0%,evaluations:+0"});
  EXPECT_EQ(same.exit_code, 0) << same.err;
  EXPECT_THAT(same.err, IsEmpty());
  EXPECT_THAT(same.out, HasSubstr("Passed: none of 3 gated results"));
  EXPECT_THAT(same.out, Not(HasSubstr("What changed")));
}

TEST_F(CliCompare, AGateThatComparesNothingFails) {
  const std::string before = file("a.jsonl", repeats("pso", 1)), after = file("b.jsonl", repeats("ceres", 1));
  const ProcessResult gone = run_bench({"compare", before, after, "--fail-on=J:+0.1%"});
  EXPECT_EQ(gone.exit_code, 1);
  EXPECT_THAT(gone.err, HasSubstr("nothing to compare: no limit of --fail-on meets a pair of results"));
  EXPECT_THAT(gone.err, HasSubstr("'pso'"));
  EXPECT_EQ(run_bench({"compare", before, after}).exit_code, 0);  // no gate, no verdict
  std::vector<RunRecord> wider = repeats("pso", 1);
  for (RunRecord& r : wider) r.parameters.push_back({"x", "1", 0, 0, -1, 1, ""});
  const ProcessResult other = run_bench({"compare", before, file("c.jsonl", wider), "--fail-on=J:+0.1%"});
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_THAT(other.err, HasSubstr("another dimension or box"));
  // One of two labels is left: what is gone is named, what is there is still judged.
  std::vector<RunRecord> both = repeats("pso", 1);
  for (const RunRecord& r : repeats("lm", 1)) both.push_back(r);
  const ProcessResult half = run_bench({"compare", file("d.jsonl", both), before, "--fail-on=J:+0.1%"});
  EXPECT_EQ(half.exit_code, 1);
  EXPECT_THAT(half.err, HasSubstr("no partner on the new side for 'lm'"));
  EXPECT_THAT(half.err, Not(HasSubstr("'pso'")));
}

// The title says what the exit code says, also where what can be compared is fine.
TEST_F(CliCompare, TheTitleAgreesWithTheExitCode) {
  std::vector<RunRecord> both = repeats("pso", 1);
  for (const RunRecord& r : repeats("lm", 1)) both.push_back(r);
  const ProcessResult half =
      run_bench({"compare", file("a.jsonl", both), file("b.jsonl", repeats("pso", 1)), "--fail-on=J:+0.1%"});
  EXPECT_EQ(half.exit_code, 1);
  EXPECT_THAT(half.out, HasSubstr("Failed: nothing to compare: no partner on the new side for 'lm'"));
  EXPECT_THAT(half.out, Not(HasSubstr("Passed")));
}

TEST_F(CliCompare, AnotherBoxIsAnotherProblem) {
  std::vector<RunRecord> before = repeats("pso", 1), after = repeats("pso", 2);
  for (RunRecord& r : before) r.box = "0123456789abcdef";
  for (RunRecord& r : after) r.box = "fedcba9876543210";
  const std::string a = file("a.jsonl", before), b = file("b.jsonl", after);
  const ProcessResult run = run_bench({"compare", a, b, "--format=csv"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.out, HasSubstr("pso,sphere,,all,old,another dimension or box\r\n"));
  EXPECT_EQ(run_bench({"compare", a, b, "--fail-on=J:+900%"}).exit_code, 1);
  // Side by side in one report they keep apart, too.
  const ProcessResult report = run_bench({"report", a, b});
  EXPECT_THAT(report.out, HasSubstr("sphere, @01234567"));
}

TEST_F(CliCompare, ASmallerBudgetIsNotBetterEffort) {
  std::vector<RunRecord> before = repeats("pso", 1), after = repeats("pso", 1);
  for (RunRecord& r : before) {
    r.budget = {{"max_evaluations", 50000}};
    r.evaluations += 40000;
  }
  for (RunRecord& r : after) {
    r.budget = {{"max_evaluations", 500}};
    r.termination = "max_evaluations";
  }
  const ProcessResult run =
      run_bench({"compare", file("a.jsonl", before), file("b.jsonl", after), "--format=json"});
  const auto tables = nlohmann::json::parse(run.out).at("tables");
  EXPECT_EQ(tables.at(0).at("rows").at(0).at("better"), 0) << run.out;
  EXPECT_EQ(tables.at(1).at("rows").at(0).at("metric"), "evaluations");
  EXPECT_EQ(tables.at(1).at("rows").at(0).at("finding"), "changed");
}

TEST_F(CliCompare, TheSameRecordReadTwiceCountsOnce) {
  const std::string runs = file("a.jsonl", repeats("pso", 1)), more = file("b.jsonl", repeats("pso", 1, 12));
  const ProcessResult report = run_bench({"report", runs, more, "--json"});
  EXPECT_EQ(report.exit_code, 0) << report.err;
  EXPECT_THAT(report.err, HasSubstr("10 records were read twice and counted once"));
  const auto tables = nlohmann::json::parse(report.out).at("tables");
  EXPECT_EQ(tables.at(1).at("id"), "repeats");
  EXPECT_EQ(tables.at(1).at("rows").at(0).at("runs"), 12);
}

TEST_F(CliCompare, ACheckOfNothingFails) {
  const std::string runs = file("a.jsonl", repeats("pso", 1));
  const std::string empty =
      folder_.file("empty.json", R"({"schema_version": 1, "tolerances": {"cost_relative": 1,
      "error_m": 1, "error_rad": 1, "total": 1, "evaluations_factor": null}, "entries": []})");
  const ProcessResult run = run_bench({"check", "--baseline=" + empty, runs});
  EXPECT_EQ(run.exit_code, kData) << run.err;
  EXPECT_THAT(run.err, HasSubstr("found an array of 0, expected at least one entry"));
  // An entry without a record fails, too.
  const std::string baseline = (folder_ / "lm.json").string();
  EXPECT_EQ(
      run_bench({"check", "--update", "--baseline=" + baseline, file("b.jsonl", repeats("lm", 1))}).exit_code,
      0);
  const ProcessResult none = run_bench({"check", "--baseline=" + baseline, runs});
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_THAT(none.err, HasSubstr("nothing to compare: no entry of "));
}

TEST_F(CliCompare, RegressionFailsOnlyBeyondAStatedLimit) {
  const std::string before = file("a.jsonl", repeats("pso", 1)), after = file("b.jsonl", repeats("pso", 1.5));
  EXPECT_EQ(run_bench({"compare", before, after}).exit_code, 0);
  EXPECT_EQ(run_bench({"compare", before, after, "--fail-on=J:+90%"}).exit_code, 0);
  const ProcessResult failed = run_bench({"compare", before, after, "--fail-on=evaluations:+50%,J:+0.1%"});
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_THAT(failed.err, IsEmpty());
  EXPECT_THAT(failed.out, HasSubstr("Failed: 1 of 2 gated results"));
  EXPECT_EQ(run_bench({"compare", before, after, "--fail-on=J:+0.1%", "--alpha=1e-9"}).exit_code, 0);
}

TEST_F(CliCompare, WhatIsNotSignificantPasses) {
  const std::string before = file("a.jsonl", repeats("pso", 1)),
                    after = file("b.jsonl", repeats("pso", 1.02));
  const ProcessResult run = run_bench({"compare", before, after, "--fail-on=J:+0.1%"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.out, HasSubstr("not significant"));
  EXPECT_THAT(run.out, HasSubstr("passed its limit without being sure"));
}

TEST_F(CliCompare, ADeterministicSolverNeedsNoRepeats) {
  const std::string before =
      file("a.jsonl", {run_record("lm", 1), run_record("pso", 1), run_record("mine", 1)});
  const std::string after =
      file("b.jsonl", {run_record("lm", 2), run_record("pso", 2), run_record("mine", 2)});
  const ProcessResult run = run_bench({"compare", before, after, "--fail-on=J:+1%", "--format=json"});
  EXPECT_EQ(run.exit_code, 1);
  const auto tables = nlohmann::json::parse(run.out).at("tables");
  EXPECT_EQ(tables.at(0).at("rows").at(0).at("failed"), 1) << "pso is random, mine is unknown";
  EXPECT_EQ(tables.at(1).at("rows").at(0).at("label"), "lm");
  EXPECT_EQ(tables.at(1).at("rows").at(0).at("change_percent"), 100);
}

TEST_F(CliCompare, MarkdownForAComment) {
  const std::string before = file("a.jsonl", repeats("pso", 1)), after = file("b.jsonl", repeats("pso", 1.5));
  const ProcessResult run = run_bench({"compare", before, after, "--fail-on=J:+0.1%", "--format=md"});
  EXPECT_EQ(run.exit_code, 1);
  const std::vector<std::string> lines = testing::lines(run.out);
  EXPECT_THAT(lines.at(0), HasSubstr("**Failed: 1 of 1"));
  EXPECT_EQ(lines.at(2), "### What changed");
  EXPECT_THAT(run.out, HasSubstr("<details>\n<summary>All 4 results</summary>\n\n### All results"));
  EXPECT_THAT(run.out, HasSubstr("\n</details>\n"));
}

TEST_F(CliCompare, ListsALabelThatOneSideLacks) {
  std::vector<RunRecord> more = repeats("pso", 1);
  more.push_back(run_record("ga", 1));
  const std::string before = file("a.jsonl", more), after = file("b.jsonl", repeats("pso", 1));
  const ProcessResult run = run_bench({"compare", before, after, "--fail-on=J:+1%", "--format=csv"});
  EXPECT_EQ(run.exit_code, 1);  // what is gone cannot have passed
  EXPECT_THAT(run.out,
              HasSubstr("#table,one_sided,On one side only\r\nlabel,problem,dataset,metric,side,remark"
                        "\r\nga,sphere,,all,old,\r\n"));
}

TEST_F(CliCompare, RefusesBadLimits) {
  const std::string runs = file("a.jsonl", repeats("pso", 1));
  const auto refusal = [&](const std::string& option) {
    const ProcessResult run = run_bench({"compare", runs, runs, option});
    EXPECT_EQ(run.exit_code, kUsage) << option;
    EXPECT_THAT(run.out, IsEmpty()) << option;
    EXPECT_EQ(testing::lines(run.err).size(), 1u) << run.err;
    return run.err;
  };
  EXPECT_THAT(refusal("--fail-on=evaluatons:+1%"), HasSubstr("did you mean 'evaluations'?"));
  EXPECT_THAT(refusal("--fail-on=J"), HasSubstr("'J': no ':', expected METRIC:LIMIT"));
  EXPECT_THAT(refusal("--fail-on=J:1%"), HasSubstr("a limit without a sign"));
  EXPECT_THAT(refusal("--fail-on=J:+x%"), HasSubstr("'x' is not a number"));
  EXPECT_THAT(refusal("--fail-on=:+1"), HasSubstr("no metric before"));
  EXPECT_THAT(refusal("--fail-on=J:-1%"), HasSubstr("J is better when lower"));
  EXPECT_THAT(refusal("--fail-on=J:+1%,J:+2"), HasSubstr("a second limit for J"));
  EXPECT_THAT(refusal("--fail-on=J:+-1"), HasSubstr("two signs"));
  EXPECT_THAT(refusal("--metrics=secnds"), HasSubstr("did you mean 'seconds'?"));
  EXPECT_THAT(refusal("--alpha=1"), HasSubstr("below 1"));
  EXPECT_THAT(refusal("--format=xml"), HasSubstr("unknown table format"));
}

TEST_F(CliCompare, RefusesMissingAndBrokenFiles) {
  const std::string runs = file("a.jsonl", repeats("pso", 1)), broken = folder_.file("b.jsonl", "{\n");
  const ProcessResult missing = run_bench({"compare", runs, (folder_ / "no.jsonl").string()});
  EXPECT_EQ(missing.exit_code, kData);
  EXPECT_THAT(missing.err, HasSubstr("no.jsonl: there is no such file"));
  const ProcessResult bad = run_bench({"compare", broken, runs});
  EXPECT_EQ(bad.exit_code, kData);
  EXPECT_THAT(bad.err, HasSubstr("b.jsonl:1"));
  EXPECT_EQ(run_bench({"compare", runs}).exit_code, kUsage);
}

}  // namespace
}  // namespace odobench
