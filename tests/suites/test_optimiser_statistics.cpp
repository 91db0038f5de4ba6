// Statistics of optimisers: small cases by hand, values of R and of enumeration, and how often known nulls
// are rejected.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/random.hpp"
#include "base/range.hpp"
#include "reports/kinds/optimisers/optimiser_tables.hpp"
#include "reports/statistics/optimisers/friedman.hpp"
#include "reports/statistics/optimisers/quantiles.hpp"
#include "reports/statistics/optimisers/runtimes.hpp"
#include "reports/statistics/optimisers/signed_rank.hpp"

namespace odobench {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

// python, mpmath with 30 digits: quad of the range's density, gammainc, betainc, erfc.
TEST(Quantiles, AgreeWithQuadrature) {
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-14);
  EXPECT_NEAR(chi_squared_tail(7.5, 3), 0.0575584519726364, 1e-14);
  EXPECT_NEAR(f_tail(3.2, 4, 12), 0.0525798591570992, 1e-14);
  EXPECT_NEAR(range_quantile(0.05, 2), 2.77180764869936, 1e-10);
  EXPECT_NEAR(range_quantile(0.05, 3), 3.31449315539812, 1e-10);
  EXPECT_NEAR(range_quantile(0.05, 5), 3.85765551037862, 1e-10);
  EXPECT_NEAR(range_quantile(0.05, 10), 4.47412422172591, 1e-10);
  EXPECT_NEAR(range_tail(3, 4), 0.14627148104766, 1e-12);
  EXPECT_EQ(range_tail(0, 4), 1);
}

// Darwin's maize, R: wilcox.test(d, conf.int = TRUE, exact = TRUE): V = 96, p-value = 0.04126; all 2^15
// signs: 1352.
TEST(SignedRank, DarwinsMaize) {
  const std::vector<double> d{6, 8, 14, 16, 23, 24, 28, 29, 41, -48, 49, 56, 60, -67, 75};
  const SignedRankTest test = signed_rank_test(d);
  EXPECT_EQ(test.positive, 96);
  EXPECT_TRUE(test.exact);
  EXPECT_DOUBLE_EQ(test.p, 1352.0 / 32768);
  // By enumeration of the means of pairs in python fractions.
  const auto shift = paired_shift(d);
  ASSERT_TRUE(shift);
  EXPECT_EQ(shift->estimate, 25);
  EXPECT_EQ(shift->lower, 4);
  EXPECT_EQ(shift->upper, 41.5);
}

TEST(SignedRank, TiesAndZeros) {
  // python: all 2^9 signs of the mean ranks of sizes, the zero left out: 44.
  const SignedRankTest test = signed_rank_test({1.5, -0.5, 2, 2, 0, -1, 0.5, 3, 2, -0.5});
  EXPECT_EQ(test.pairs, 9u);
  EXPECT_EQ(test.positive, 37);
  EXPECT_DOUBLE_EQ(test.p, 44.0 / 512);
  EXPECT_EQ(signed_rank_test({0, 0, kNotANumber}).p, 1);
  EXPECT_EQ(signed_rank_test({}).p, 1);
  // Failures of one side have the largest ranks: as if by far the largest differences.
  EXPECT_EQ(signed_rank_test({1, 2, -kInfinity}).p, signed_rank_test({1, 2, -1000}).p);
  EXPECT_EQ(signed_rank_test({1, 2, 3, 4, 5}).p, 2.0 / 32);
}

TEST(SignedRank, NormalIsNearExact) {
  Random random(5);
  std::vector<double> d;
  for (int i = 0; i < 45; ++i) d.push_back(random.normal() + 0.3);
  EXPECT_NEAR(signed_rank_normal(d).p, signed_rank_test(d).p, 0.002);
  EXPECT_LT(signed_rank_test(d).p, 0.2);
  for (int i = 0; i < 10; ++i) d.push_back(random.normal());
  EXPECT_FALSE(signed_rank_test(d).exact);
}

TEST(PairedShift, ByHand) {
  // Means of pairs: 1, 1.5, 2, 2.5, 3, 4.
  const auto three = paired_shift({1, 2, 4});
  ASSERT_TRUE(three);
  EXPECT_EQ(three->estimate, 2.25);
  EXPECT_FALSE(three->lower);  // 3 pairs: at best 75 %
  EXPECT_FALSE(paired_shift({1, 2, 3, 4, 5})->lower);
  // P(W+ <= 0) = 1/64 <= 2.5 % < P(W+ <= 1): the extremes.
  const auto six = paired_shift({1, 2, 3, 4, 5, 6});
  EXPECT_EQ(six->estimate, 3.5);
  EXPECT_EQ(six->lower, 1);
  EXPECT_EQ(six->upper, 6);
  EXPECT_FALSE(paired_shift({}));
  EXPECT_FALSE(paired_shift({1, kInfinity}));
}

// 81 of 263 and 0 of 10: R. G. Newcombe, Statistics in Medicine 17, 1998 (0.2553 to 0.3662; 0 to 0.2775);
// 3 of 15 in python, mpmath.
TEST(Wilson, PublishedIntervals) {
  EXPECT_NEAR(wilson_interval(81, 263).lower, 0.255288519878274, 1e-13);
  EXPECT_NEAR(wilson_interval(81, 263).upper, 0.3662095769828, 1e-13);
  EXPECT_EQ(wilson_interval(0, 10).lower, 0);
  EXPECT_NEAR(wilson_interval(0, 10).upper, 0.277532799862889, 1e-13);
  EXPECT_EQ(wilson_interval(10, 10).upper, 1);
  EXPECT_NEAR(wilson_interval(3, 15).lower, 0.0704754934698156, 1e-13);
  EXPECT_NEAR(wilson_interval(3, 15).upper, 0.451854487151694, 1e-13);
  EXPECT_THROW(wilson_interval(0, 0), std::invalid_argument);
  EXPECT_THROW(wilson_interval(3, 2), std::invalid_argument);
}

// Hollander and Wolfe (1973), p. 140, R: friedman.test(RoundingTimes): chi-squared = 11.1429, df = 2,
// p-value = 0.003805. F's p is x^21, x = 42 / (42 + 2 F), since it has two degrees.
TEST(Friedman, RoundingTimes) {
  const std::vector<std::vector<double>> times{
      {5.40, 5.50, 5.55}, {5.85, 5.70, 5.75}, {5.20, 5.60, 5.50}, {5.55, 5.50, 5.40}, {5.90, 5.85, 5.70},
      {5.45, 5.55, 5.60}, {5.40, 5.40, 5.35}, {5.45, 5.50, 5.35}, {5.25, 5.15, 5.00}, {5.85, 5.80, 5.70},
      {5.25, 5.20, 5.10}, {5.65, 5.55, 5.45}, {5.60, 5.35, 5.45}, {5.05, 5.00, 4.95}, {5.50, 5.50, 5.40},
      {5.45, 5.55, 5.50}, {5.55, 5.55, 5.35}, {5.45, 5.50, 5.55}, {5.50, 5.45, 5.25}, {5.65, 5.60, 5.40},
      {5.70, 5.65, 5.55}, {6.30, 6.30, 6.25}};
  const FriedmanTest test = friedman_test(times);
  EXPECT_THAT(test.mean_ranks, ElementsAre(53.0 / 22, 47.0 / 22, 32.0 / 22));
  EXPECT_NEAR(test.chi_squared, 11.142857142857142, 1e-12);
  EXPECT_NEAR(test.p, 0.003805040775511383, 1e-14);
  EXPECT_NEAR(test.f, 7.121739130434783, 1e-11);
  EXPECT_NEAR(test.f_p, std::pow(42 / (42 + 2 * test.f), 21), 1e-14);
}

TEST(Friedman, FailuresAndExtremes) {
  const FriedmanTest same = friedman_test({{1, 1, 1}, {kInfinity, kInfinity, kNotANumber}});
  EXPECT_THAT(same.mean_ranks, ElementsAre(2, 2, 2));
  EXPECT_EQ(same.p, 1);
  const FriedmanTest always = friedman_test({{1, 2}, {3, kInfinity}, {5, 6}});
  EXPECT_EQ(always.chi_squared, 3);
  EXPECT_EQ(always.f_p, 0);
  EXPECT_THROW(friedman_test({{1, 2}}), std::invalid_argument);
  EXPECT_THROW(friedman_test({{1, 2}, {1, 2, 3}}), std::invalid_argument);
}

// J. Demsar, JMLR 7, 2006: table 5 (a), whose digits come from rounded quantiles of the range, and 1.25
// for four classifiers on 14 data sets.
TEST(Nemenyi, DemsarsTable) {
  const double q[] = {1.960, 2.343, 2.569, 2.728, 2.850, 2.949, 3.031, 3.102, 3.164};
  for (std::size_t k = 2; k <= 10; ++k)
    EXPECT_NEAR(range_quantile(0.05, static_cast<int>(k)) / std::sqrt(2.0), q[k - 2], 8e-4) << k;
  EXPECT_NEAR(nemenyi_difference(4, 14), 1.25, 0.005);
  EXPECT_NEAR(nemenyi_p(nemenyi_difference(4, 14), 4, 14), 0.05, 1e-12);
}

TEST(Nemenyi, BarsAreMaximal) {
  EXPECT_THAT(rank_bars({1, 3, 1.5, 2.4}, 1), ElementsAre(RankBar{0, 1}, RankBar{1, 2}, RankBar{2, 3}));
  EXPECT_THAT(rank_bars({1, 1.2, 1.9, 3.5}, 1), ElementsAre(RankBar{0, 2}));
  EXPECT_THAT(rank_bars({1, 2.5, 4}, 1), IsEmpty());
}

// Under the null tests reject as often as they say, within three deviations of the simulation.
TEST(TestsOfTests, NullsAreRejectedAtTheStatedRate) {
  Random random(20);
  constexpr int kRuns = 3000;
  int signed_rank = 0, covered = 0, friedman = 0, nemenyi = 0;
  const double difference = nemenyi_difference(4, 20);
  for (int run = 0; run < kRuns; ++run) {
    std::vector<double> d;
    for (int i = 0; i < 12; ++i) d.push_back(random.normal());
    if (signed_rank_test(d).p <= 0.05) ++signed_rank;
    const auto shift = paired_shift(d);
    if (*shift->lower <= 0 && *shift->upper >= 0) ++covered;
    std::vector<std::vector<double>> scores(20, std::vector<double>(4));
    for (auto& row : scores)
      for (double& score : row) score = random.uniform();
    const FriedmanTest test = friedman_test(scores);
    if (test.f_p <= 0.05) ++friedman;
    const auto [low, high] = std::minmax_element(test.mean_ranks.begin(), test.mean_ranks.end());
    if (*high - *low > difference) ++nemenyi;
  }
  // Exact: the largest attainable level of 12 pairs is 2 * 87 / 4096 = 4.2 %.
  EXPECT_NEAR(signed_rank / double{kRuns}, 2 * 87.0 / 4096, 0.011);
  EXPECT_NEAR(covered / double{kRuns}, 1 - 2 * 87.0 / 4096, 0.011);
  EXPECT_NEAR(friedman / double{kRuns}, 0.05, 0.014);
  EXPECT_NEAR(nemenyi / double{kRuns}, 0.05, 0.014);
}

TEST(TestsOfTests, WilsonCoversOnTheAverage) {
  double sum = 0;
  int count = 0;
  constexpr int n = 20;
  for (double p = 0.05; p < 0.96; p += 0.01, ++count) {
    double term = std::pow(1 - p, n);
    for (int k = 0; k <= n; term *= (n - k) * p / ((k + 1) * (1 - p)), ++k) {
      const ShareInterval share = wilson_interval(static_cast<std::size_t>(k), n);
      if (share.lower <= p && p <= share.upper) sum += term;
    }
  }
  EXPECT_NEAR(sum / count, 0.95, 0.007);
}

Trial trial(std::vector<std::pair<double, double>> steps, double spent) {
  Trial t;
  t.steps = std::move(steps);
  t.spent = spent;
  return t;
}

TEST(Runtimes, ExpectedByHand) {
  // Successes after 100 and 300, a failure of 1000: (100 + 1000 + 300) / 2.
  const std::vector<Trial> trials{trial({{10, 1}, {100, 0.01}}, 150), trial({{10, 1}}, 1000),
                                  trial({{300, 0}}, 300)};
  const ExpectedRuntime ert = expected_runtime(trials, 0.01);
  EXPECT_EQ(ert.evaluations, 700);
  EXPECT_EQ(ert.successes, 2u);
  EXPECT_EQ(expected_runtime(trials, 1).evaluations, (10 + 10 + 300) / 3.0);
  EXPECT_EQ(expected_runtime(trials, -1).evaluations, kInfinity);
  EXPECT_EQ(expected_runtime({}, 1).evaluations, kInfinity);
  EXPECT_EQ(median_runtime(trials, 0.01), 300);
  EXPECT_EQ(median_runtime(trials, 0.001), kInfinity);
}

// Restarts until success: their mean is the ERT, here 100 + 1000 (1 - p) / p with p = 1/2.
TEST(Runtimes, RestartsHaveTheExpectedMean) {
  const std::vector<Trial> trials{trial({{100, 0}}, 100), trial({{5, 1}}, 1000)};
  const std::vector<double> runtimes = restarted_runtimes(trials, 0.5, 20000, 3);
  double sum = 0;
  for (const double r : runtimes) {
    sum += r;
    EXPECT_EQ(std::fmod(r, 1000), 100);
  }
  EXPECT_NEAR(sum / 20000, expected_runtime(trials, 0.5).evaluations, 40);
  EXPECT_EQ(runtimes, restarted_runtimes(trials, 0.5, 20000, 3));
  EXPECT_NE(runtimes, restarted_runtimes(trials, 0.5, 20000, 4));
  EXPECT_THAT(restarted_runtimes(trials, -1, 10, 3), IsEmpty());
}

TEST(Runtimes, DistributionByHand) {
  TrialTable table;
  table.solvers = {"a"};
  table.problems.push_back({"p", true, 2, {{trial({{10, 50}, {20, 0.9e-3}}, 40)}}});
  // 51 targets: 100 and 63 after 10 evaluations, 40 down to 1e-3 (24 of them) after 20, the rest never.
  const StepCurve curve = runtime_distribution(table, 0);
  EXPECT_EQ(value_at(curve, 4.9), 0);
  EXPECT_DOUBLE_EQ(value_at(curve, 5), 2.0 / 51);
  EXPECT_DOUBLE_EQ(value_at(curve, 10), 26.0 / 51);
  EXPECT_DOUBLE_EQ(value_at(curve, kInfinity), 26.0 / 51);
  EXPECT_THAT(ecdf_targets(true), SizeIs(51));
  EXPECT_THAT(ecdf_targets(false), SizeIs(40));
  EXPECT_DOUBLE_EQ(ecdf_targets(true).back(), 1e-8);
}

TEST(Runtimes, ProfilesByHand) {
  TrialTable table;
  table.solvers = {"a", "b"};
  table.problems.push_back({"one", false, 1, {{trial({{4, 0}}, 4)}, {trial({{8, 0}}, 8)}}});
  table.problems.push_back({"two", false, 3, {{trial({{1, 0.5}}, 9)}, {trial({{4, 0}}, 4)}}});
  table.problems.push_back({"none", false, 1, {{trial({{1, 0.5}}, 9)}, {}}});
  const StepCurve a = data_profile(table, 0, 0.1), b = data_profile(table, 1, 0.1);
  EXPECT_EQ(value_at(a, 1.9), 0);
  EXPECT_DOUBLE_EQ(value_at(a, 2), 1.0 / 3);  // 4 evaluations, n + 1 = 2
  EXPECT_DOUBLE_EQ(value_at(b, 1), 1.0 / 3);  // 4 of n + 1 = 4
  EXPECT_DOUBLE_EQ(value_at(b, 4), 2.0 / 3);
  const StepCurve ratio_a = performance_profile(table, 0, 0.1), ratio_b = performance_profile(table, 1, 0.1);
  EXPECT_DOUBLE_EQ(value_at(ratio_a, 1), 1.0 / 3);
  EXPECT_DOUBLE_EQ(value_at(ratio_a, kInfinity), 1.0 / 3);
  EXPECT_DOUBLE_EQ(value_at(ratio_b, 1), 1.0 / 3);
  EXPECT_DOUBLE_EQ(value_at(ratio_b, 2), 2.0 / 3);
}

RunRecord record(const std::string& problem, const std::string& label, int repetition,
                 std::vector<TracePoint> trace, std::optional<double> known = std::nullopt) {
  RunRecord r;
  r.problem = problem;
  r.label = r.solver = label;
  r.kind = "run";
  r.repetition = repetition;
  r.trace = std::move(trace);
  r.cost = r.trace.back().cost;
  r.evaluations = r.trace.back().evaluations;
  r.parameters = {{"x1", "1", 0, 0, -1, 1, ""}, {"x2", "1", 0, 0, -1, 1, ""}};
  if (known) r.known = KnownAnswer{*known, std::nullopt, false, std::nullopt};
  return r;
}

TEST(Trials, GapsAndInstances) {
  const std::vector<RunRecord> records{
      record("bbob:f1[n=2]", "a", 1, {{1, 0, 12}, {5, 0, 2.5}}, 2.0),
      record("bbob:f1[n=2,instance=2]", "a", 1, {{1, 0, -3}, {7, 0, -9.75}}, -10.0),
      record("bbob:f1[n=2]", "b", 1, {{1, 0, 12}}, 2.0),
      record("free", "a", 1, {{1, 0, 11}, {3, 0, 2}}),
      record("free", "b", 1, {{1, 0, 11}, {4, 0, 1}}),
      record("lonely", "a", 1, {{1, 0, 1}})};
  const TrialTable table = trial_table(records);
  EXPECT_THAT(table.solvers, ElementsAre("a", "b"));
  ASSERT_THAT(table.problems, SizeIs(2));
  const ProblemTrials& f1 = table.problems[0];
  EXPECT_EQ(f1.problem, "bbob:f1[n=2]");
  EXPECT_EQ(f1.dimension, 2u);
  ASSERT_THAT(f1.of[0], SizeIs(2));
  EXPECT_EQ(f1.of[0][0].evaluations_to(0.5), 5);
  EXPECT_EQ(f1.of[0][1].evaluations_to(0.5), 7);  // in units of the cost
  EXPECT_FALSE(f1.of[0][0].evaluations_to(0.49));
  // Without a known optimum the lowest of all runs, 1; in units of the start's gap, 10.
  EXPECT_EQ(table.problems[1].of[0][0].evaluations_to(0.1), 3);
  EXPECT_EQ(table.problems[1].of[1][0].evaluations_to(0), 4);
}

TEST(Trials, NamesWithoutInstance) {
  EXPECT_EQ(without_instance("bbob:f1[n=5,instance=3]"), "bbob:f1[n=5]");
  EXPECT_EQ(without_instance("bbob:f1[instance=3]"), "bbob:f1");
  EXPECT_EQ(without_instance("bbob:f1[instance=3,n=5]"), "bbob:f1[n=5]");
  EXPECT_EQ(without_instance("bbob:f1[n=5]"), "bbob:f1[n=5]");
  EXPECT_EQ(without_instance("sphere"), "sphere");
  EXPECT_EQ(without_instance("instance=3]"), "instance=3]");
}

std::vector<RunRecord> two_solvers(int problems) {
  std::vector<RunRecord> records;
  for (int k = 0; k < problems; ++k) {
    const std::string problem = "p" + std::to_string(k);
    records.push_back(record(problem, "quick", 1, {{1, 0, 1}, {10, 0, 0}}, 0.0));
    records.push_back(record(problem, "slow", 1, {{1, 0, 1}, {40, 0, 0}}, 0.0));
  }
  return records;
}

TEST(OptimiserTables, FromThreeProblemsOn) {
  EXPECT_THAT(optimiser_tables(two_solvers(2)), IsEmpty());
  const std::vector<Table> tables = optimiser_tables(two_solvers(6));
  ASSERT_THAT(tables, SizeIs(4));
  EXPECT_EQ(tables[0].id, "ert");
  EXPECT_EQ(tables[0].rows.size(), 12u);
  EXPECT_EQ(tables[0].rows[1][6].value, 40);
  EXPECT_EQ(tables[1].id, "profiles");
  EXPECT_EQ(tables[2].id, "ranks");
  EXPECT_EQ(tables[2].rows[0][1].value, 1);
  EXPECT_EQ(tables[2].rows[1][1].value, 2);
  ASSERT_EQ(tables[3].id, "rank_pairs");
  ASSERT_THAT(tables[3].rows, SizeIs(1));
  EXPECT_DOUBLE_EQ(*tables[3].rows[0][5].value, 2.0 / 64);  // six pairs, all of one sign
  EXPECT_NEAR(*tables[3].rows[0][7].value, 4, 1e-12);       // 40 evaluations for 10
  EXPECT_EQ(tables[3].rows[0][8].text, "[4, 4]");
}

TEST(OptimiserTables, SectionsOfThePage) {
  Document document;
  add_optimiser_sections(two_solvers(2), document);
  EXPECT_THAT(document.sections, IsEmpty());
  add_optimiser_sections(two_solvers(3), document);
  ASSERT_THAT(document.sections, SizeIs(3));
  EXPECT_EQ(document.sections[0].id, "ert");
  std::vector<std::string> ids;
  for (const Figure* figure : figures(document)) {
    ids.push_back(figure->id);
    EXPECT_TRUE(standalone(*figure, document.datasets).contains("data"));
  }
  EXPECT_THAT(ids,
              ElementsAre("ert.ecdf", "profiles.data", "profiles.performance", "ranks.critical_difference"));
  EXPECT_THAT(document.datasets["ranks.critical_difference"], HasSubstr("solver,0,1,1,0"));
}

}  // namespace
}  // namespace odobench
