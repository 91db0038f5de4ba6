// Two sets of records side by side: what counts as a change, and what fails.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "reports/records/schema_1.hpp"
#include "reports/regression/changes.hpp"
#include "tests/support/data/report_records.hpp"

namespace odobench {
namespace {

using testing::calibration_record;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::run_record;

constexpr double kInf = std::numeric_limits<double>::infinity();

// "pso" is random, everything else is not.
CompareOptions options(std::vector<Gate> gates = {}) {
  CompareOptions o;
  o.gates = std::move(gates);
  o.random = [](const RunRecord& r) { return r.solver == "pso"; };
  return o;
}

// Ten runs of a random solver, J = first, first + step, ...
std::vector<RunRecord> repeats(double first, double step, int count = 10) {
  std::vector<RunRecord> records;
  for (int i = 0; i < count; ++i) records.push_back(run_record("pso", first + step * i, i + 1));
  return records;
}

const Change& change_of(const RunComparison& comparison, const std::string& metric,
                        const std::string& label = "pso") {
  for (const Change& c : comparison.changes)
    if (c.before.name == metric && c.label == label) return c;
  throw std::runtime_error("no " + metric);
}

TEST(CompareRuns, NothingChanged) {
  const RunComparison c = compare_runs(repeats(1, 0.01), repeats(1, 0.01), options({{"J", 0, false}}));
  EXPECT_EQ(c.count(Finding::Equal), c.changes.size());
  EXPECT_EQ(change_of(c, "J").test->p, 1);
  EXPECT_EQ(c.failures(), 0u);
  EXPECT_EQ(c.gated, 1u);
  EXPECT_THAT(c.one_sided, IsEmpty());
  EXPECT_THAT(c.unlike, IsEmpty());
  EXPECT_THAT(verdict(c), HasSubstr("Passed: none of 1 gated results"));
}

TEST(CompareRuns, LimitMustBePassedAndTheChangeSure) {
  const auto failures = [](const std::vector<RunRecord>& after, Gate gate) {
    return compare_runs(repeats(1, 0.01), after, options({std::move(gate)})).failures();
  };
  EXPECT_EQ(failures(repeats(1.2, 0.01), {"J", 0.1, true}), 1u);
  EXPECT_EQ(failures(repeats(1.2, 0.01), {"J", 0.21, false}), 0u) << "within the limit";
  EXPECT_EQ(failures(repeats(1.2, 0.01), {"J", 0.19, false}), 1u);
  EXPECT_EQ(failures(repeats(0.8, 0.01), {"J", 0.1, true}), 0u) << "an improvement";
  EXPECT_EQ(failures(repeats(1.02, 0.01), {"J", 0.01, true}), 0u) << "beyond the limit, but not significant";
  EXPECT_EQ(failures(repeats(1.2, 0.01), {"total", 0, true}), 0u) << "another metric";
}

TEST(CompareRuns, TooFewRunsSayNothing) {
  const RunComparison c = compare_runs(repeats(1, 0.01, 3), repeats(5, 0.01, 3), options({{"J", 0, false}}));
  EXPECT_EQ(change_of(c, "J").finding, Finding::TooFewRuns);
  EXPECT_TRUE(change_of(c, "J").beyond);
  EXPECT_EQ(c.failures(), 0u);
  EXPECT_THAT(c.remarks, ElementsAre(HasSubstr("1 gated result passed its limit without being sure")));
  const RunComparison single = compare_runs(repeats(1, 0, 1), repeats(5, 0, 1), options({{"J", 0, false}}));
  EXPECT_EQ(change_of(single, "J").finding, Finding::SingleRuns);
  EXPECT_EQ(single.failures(), 0u);
}

TEST(CompareRuns, SingleRunsWithoutNoiseAreSureButForTimes) {
  RunRecord before = run_record("lm", 1), after = run_record("lm", 1.01);
  after.seconds = 100;
  const CompareOptions gated = options({{"J", 0.001, true}, {"seconds", 0.2, true}});
  const RunComparison c = compare_runs({before}, {after}, gated);
  EXPECT_TRUE(change_of(c, "J", "lm").fails);
  EXPECT_EQ(change_of(c, "J", "lm").finding, Finding::Worse);
  EXPECT_FALSE(change_of(c, "J", "lm").test);
  EXPECT_EQ(change_of(c, "seconds", "lm").finding, Finding::SingleRuns);
  EXPECT_FALSE(change_of(c, "seconds", "lm").fails);
  EXPECT_EQ(c.failures(), 1u);

  // Anything that makes the two runs differ by more than the program takes the certainty away.
  const auto fails_with = [&](const std::function<void(RunRecord&)>& change) {
    RunRecord other = after;
    change(other);
    return compare_runs({before}, {other}, gated).failures();
  };
  EXPECT_EQ(fails_with([](RunRecord& r) { r.base_seed = r.seed = 9; }), 1u) << "nothing draws from it";
  EXPECT_EQ(fails_with([](RunRecord& r) { r.options["damping"] = "2"; }), 0u);
  EXPECT_EQ(fails_with([](RunRecord& r) { r.dataset_sha256 = "00"; }), 0u);
  EXPECT_EQ(fails_with([](RunRecord& r) { r.termination = "time_limit"; }), 0u);
  EXPECT_EQ(fails_with([](RunRecord& r) { r.solver = "pso"; }), 0u);
  EXPECT_EQ(fails_with([](RunRecord& r) { r.start = "random"; }), 0u);
  CompareOptions unknown = gated;
  unknown.random = nullptr;
  EXPECT_EQ(compare_runs({before}, {after}, unknown).failures(), 0u);
}

TEST(CompareRuns, RoundingIsNoChangeButLimitsAreKept) {
  const RunComparison c =
      compare_runs({run_record("lm", 1)}, {run_record("lm", 1 + 1e-12)}, options({{"J", 1e-13, false}}));
  EXPECT_EQ(change_of(c, "J", "lm").finding, Finding::Rounding);
  EXPECT_TRUE(change_of(c, "J", "lm").fails);
}

TEST(CompareRuns, FailedRunsAreWorst) {
  std::vector<RunRecord> broken = repeats(1, 0.01);
  for (std::size_t i = 0; i < 8; ++i) broken[i].cost.reset();
  const RunComparison c = compare_runs(repeats(1, 0.01), broken, options({{"J", 0.1, true}}));
  EXPECT_EQ(change_of(c, "J").new_median, kInf);
  EXPECT_EQ(change_of(c, "J").relative, kInf);
  EXPECT_EQ(change_of(c, "J").shift, std::nullopt);
  EXPECT_TRUE(change_of(c, "J").fails);
  RunRecord lost = run_record("lm", 0);
  lost.cost.reset();
  EXPECT_EQ(compare_runs({run_record("lm", 1)}, {lost}, options({{"J", 1, true}})).failures(), 1u);
  EXPECT_EQ(change_of(compare_runs({lost}, {lost}, options()), "J", "lm").finding, Finding::Equal);
}

TEST(CompareRuns, ChangeFromZeroIsInfinite) {
  const RunComparison c =
      compare_runs({run_record("lm", 0)}, {run_record("lm", 1e-3)}, options({{"J", 5, true}}));
  EXPECT_EQ(change_of(c, "J", "lm").relative, kInf);
  EXPECT_TRUE(change_of(c, "J", "lm").fails);
}

TEST(CompareRuns, HolmRunsOverTheGatedTestsAlone) {
  std::vector<RunRecord> before = repeats(1, 0.01), after = repeats(1.045, 0.01);
  for (std::size_t i = 0; i < 10; ++i) {  // iterations cannot be told apart
    before[i].iterations = static_cast<int>(i);
    after[i].iterations = static_cast<int>(i) + 100;
    before[i].seconds = after[i].seconds = 1;
  }
  const RunComparison alone = compare_runs(before, after, options({{"J", 0, false}}));
  const double p = change_of(alone, "J").test->p;
  EXPECT_EQ(change_of(alone, "J").p_adjusted, p);
  EXPECT_EQ(alone.gated_tests, 1u);
  EXPECT_EQ(alone.tests, 3u);
  const RunComparison both = compare_runs(before, after, options({{"J", 0, false}, {"seconds", 0, false}}));
  EXPECT_EQ(change_of(both, "J").p_adjusted, 2 * p);
  EXPECT_TRUE(change_of(alone, "J").fails);
  CompareOptions strict = options({{"J", 0, false}, {"seconds", 0, false}});
  strict.alpha = 1.5 * p;
  EXPECT_FALSE(change_of(compare_runs(before, after, strict), "J").fails);
}

TEST(CompareRuns, TimesOfAnotherProcessorAreNotGatedUnlessAskedFor) {
  std::vector<RunRecord> before = repeats(1, 0), after = repeats(1, 0);
  for (RunRecord& r : after) {
    r.seconds = 10;
    r.context.cpu = "new";
  }
  for (RunRecord& r : before) r.context.cpu = "old";
  CompareOptions o = options({{"seconds", 0.2, true}});
  const RunComparison c = compare_runs(before, after, o);
  EXPECT_EQ(c.failures(), 0u);
  EXPECT_EQ(c.gated, 0u);
  EXPECT_THAT(c.remarks, ElementsAre(HasSubstr("different processors")));
  EXPECT_THAT(c.unlike, ElementsAre("processor new, was old"));
  o.gate_foreign_times = true;
  EXPECT_EQ(compare_runs(before, after, o).failures(), 1u);
}

TEST(CompareRuns, KernelsThatDifferAreNamed) {
  std::vector<RunRecord> before = repeats(1, 0), after = repeats(1, 0);
  for (RunRecord& r : after) r.context.kernel = "baseline";
  EXPECT_TRUE(compare_runs(before, after, options({})).unlike.empty());  // older records do not say
  for (RunRecord& r : before) r.context.kernel = "avx2";
  EXPECT_THAT(compare_runs(before, after, options({})).unlike, ElementsAre("kernel baseline, was avx2"));
}

TEST(CompareRuns, ListsWhatOneSideHas) {
  std::vector<RunRecord> before{run_record("lm", 1), run_record("ga", 1)};
  std::vector<RunRecord> after{run_record("lm", 1), run_record("ip", 1)};
  before[0].measures.put({"gap_exact_mean", 1, "", Better::Lower});
  const RunComparison c = compare_runs(before, after, options());
  std::vector<std::string> list;
  for (const OneSided& o : c.one_sided)
    list.push_back(o.label + " " + o.metric + (o.in_old ? " old" : " new"));
  EXPECT_THAT(list, ElementsAre("lm gap_exact_mean old", "ga  old", "ip  new"));
  RunRecord skipped = run_record("lm", 1);
  skipped.kind = "skipped";
  skipped.cost.reset();
  skipped.message = "needs residuals";
  const RunComparison s = compare_runs({run_record("lm", 1)}, {skipped}, options());
  ASSERT_EQ(s.one_sided.size(), 1u);
  EXPECT_EQ(s.one_sided[0].remark, "skipped: needs residuals");
}

TEST(CompareRuns, SaysWhatMakesTheSidesUnlike) {
  RunRecord a = calibration_record("lm", "run", 1, 0.1), b = a;
  b.options["damping"] = "2";
  b.dataset_sha256 = "0123456789";
  a.dataset_sha256 = "fedcba9876";
  b.parameters[0].upper *= 2;
  a.budget = {{"max_evaluations", 100}};
  b.budget = {{"max_evaluations", 200}};
  b.base_seed = 4;
  EXPECT_THAT(compare_runs({a}, {b}, options()).unlike,
              ElementsAre("data set demo: other content (SHA-256 01234567.., was fedcba98..)",
                          "lm: option damping 2, was absent", "base seed 4, was 0",
                          "budget max_evaluations 200, was 100",
                          "lm: nominal value or bounds of parameter a1 differ"));
}

TEST(CompareRuns, MetricsOfACalibration) {
  const RunRecord r = calibration_record("lm", "run", 1, 0.1);
  CompareOptions o = options();
  o.metrics = {"e_sr", "total"};
  std::vector<std::string> names;
  for (const Change& c : compare_runs({r}, {r}, o).changes) names.push_back(c.before.name);
  EXPECT_THAT(names, ElementsAre("total", "e_sr.line_x.x", "e_sr.line_x.y", "e_sr.line_x.theta",
                                 "e_sr.circle.x", "e_sr.circle.y", "e_sr.circle.theta"));
  // line_x: (0.1 + 0.3) / 2, circle: 0.2; y and theta are 2 and 3 times that.
  EXPECT_NEAR(compare_runs({r}, {r}, o).changes[0].old_median, 0.4 * 6, 1e-12);
  EXPECT_EQ(Gate({"J", 0.001, true}).text(), "J:+0.1%");
  EXPECT_EQ(Gate({"windows_per_second", -20, false}).text(), "windows_per_second:-20");
}

TEST(CompareRuns, HigherCanBeBetter) {
  std::vector<RunRecord> before = repeats(1, 0), after = repeats(1, 0);
  for (std::size_t i = 0; i < 10; ++i) {
    before[i].measures.put({"at_optimum", 0.9 + 0.001 * static_cast<double>(i), "", Better::Higher});
    after[i].measures.put({"at_optimum", 0.5 + 0.001 * static_cast<double>(i), "", Better::Higher});
  }
  const RunComparison c = compare_runs(before, after, options({{"at_optimum", -0.2, false}}));
  EXPECT_EQ(change_of(c, "at_optimum").finding, Finding::Worse);
  EXPECT_EQ(change_of(c, "at_optimum").a12, 0);
  EXPECT_TRUE(change_of(c, "at_optimum").fails);
  EXPECT_EQ(compare_runs(after, before, options({{"at_optimum", -0.2, false}})).failures(), 0u);
}

TEST(CompareRuns, DeviationsOfAFilterAreBetterWhenSmaller) {
  std::vector<RunRecord> before = repeats(1, 0), after = repeats(1, 0);
  for (std::size_t i = 0; i < before.size(); ++i)
    for (const char* name :
         {"track.end.after", "track.max.after", "track.max.before", "noise.ax.rms.after"}) {
      before[i].measures.put(schema_1_measure(name, 0.5 + 0.001 * static_cast<double>(i)));
      after[i].measures.put(schema_1_measure(name, 0.9 + 0.001 * static_cast<double>(i)));
    }
  const RunComparison c = compare_runs(before, after, options());
  EXPECT_EQ(change_of(c, "track.end.after").finding, Finding::Worse);
  EXPECT_EQ(change_of(c, "track.max.after").finding, Finding::Worse);
  EXPECT_EQ(change_of(c, "noise.ax.rms.after").finding, Finding::Worse);
  EXPECT_EQ(change_of(c, "track.max.before").finding, Finding::Changed);  // what the sensors did
}

TEST(ChangeTables, SummaryForACommentComesInOneOrder) {
  const RunComparison c = compare_runs(repeats(1, 0.01), repeats(1.5, 0.01), options({{"J", 0.1, true}}));
  const std::string text = change_summary_markdown(c);
  EXPECT_EQ(text.rfind("**Failed: 1 of 1 gated results is worse beyond its limit: pso J (+47.8 %).**\n", 0),
            0u)
      << text;
  const auto table = text.find("### What changed"), fold = text.find("<details>"),
             all = text.find("### All results"), end = text.find("</details>");
  EXPECT_LT(table, fold);
  EXPECT_LT(fold, all);
  EXPECT_LT(all, end);
  EXPECT_NE(end, std::string::npos);
  EXPECT_THAT(text, HasSubstr("| worse | +10% FAILED |"));
}

}  // namespace
}  // namespace odobench
