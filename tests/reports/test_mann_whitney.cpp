// Rank test, effect size, shift and the correction for many tests.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "reports/statistics/mann_whitney.hpp"

namespace odobench {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using Sample = std::vector<double>;

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// U by its definition over pairs, doubled to stay an integer.
int doubled_u(const Sample& before, const Sample& after) {
  int u = 0;
  for (double a : before)
    for (double b : after) u += b > a ? 2 : b == a ? 1 : 0;
  return u;
}

// p by its definition: every way to deal the values out, one by one.
double enumerated_p(const Sample& before, const Sample& after) {
  Sample all = before;
  all.insert(all.end(), after.begin(), after.end());
  const auto pairs = static_cast<int>(before.size() * after.size());
  const int seen = std::abs(doubled_u(before, after) - pairs);
  double far = 0, deals = 0;
  for (unsigned mask = 0; mask < (1u << all.size()); ++mask) {
    Sample a, b;
    for (std::size_t i = 0; i < all.size(); ++i) ((mask >> i) & 1u ? a : b).push_back(all[i]);
    if (a.size() != before.size()) continue;
    ++deals;
    far += std::abs(doubled_u(a, b) - pairs) >= seen ? 1 : 0;
  }
  return far / deals;
}

// Values of a small generator, rounded to `levels` of them so that there are ties.
Sample values(std::size_t count, unsigned seed, unsigned levels, double shift = 0) {
  Sample sample;
  std::uint64_t state = seed;
  for (std::size_t i = 0; i < count; ++i) {
    state = state * 6364136223846793005ull + 1442695040888963407ull;
    sample.push_back(static_cast<double>((state >> 33) % levels) + shift);
  }
  return sample;
}

TEST(RankTest, EqualsTheEnumerationOfAllDeals) {
  for (unsigned levels : {2u, 3u, 6u, 1000u})
    for (std::size_t n1 = 1; n1 <= 6; ++n1)
      for (std::size_t n2 = 1; n2 <= 6; ++n2) {
        const Sample a = values(n1, 7 * levels + static_cast<unsigned>(n1), levels);
        const Sample b =
            values(n2, 11 * levels + static_cast<unsigned>(n2) + 100, levels, levels > 6 ? 300 : 0);
        const RankTest test = rank_test(a, b);
        EXPECT_TRUE(test.exact);
        EXPECT_EQ(2 * test.u, doubled_u(a, b));
        EXPECT_NEAR(test.p, enumerated_p(a, b), 1e-14) << n1 << " " << n2 << " " << levels;
      }
}

// Two-sided critical values at 5 % of the published tables (e.g. S. Siegel 1956, table K): U = 23 for 10 and
// 10, 2 for 5 and 5,
// 127 for 20 and 20 are the largest that are significant; the next is not.
TEST(RankTest, MeetsPublishedCriticalValues) {
  // `count` values each; `after` wins exactly u pairs.
  const auto p_of = [](int count, int u) {
    Sample before, after;
    for (int i = 0; i < count; ++i) before.push_back(i + 1);
    for (int i = 0; i < count; ++i) {
      const int wins = std::clamp(u - i * count, 0, count);
      after.push_back(wins + 0.5 - 1e-6 * i);
    }
    const RankTest test = rank_test(before, after);
    EXPECT_EQ(test.u, u);
    return test.p;
  };
  EXPECT_LE(p_of(10, 23), 0.05);
  EXPECT_GT(p_of(10, 24), 0.05);
  EXPECT_LE(p_of(5, 2), 0.05);
  EXPECT_GT(p_of(5, 3), 0.05);
  EXPECT_LE(p_of(20, 127), 0.05);
  EXPECT_GT(p_of(20, 128), 0.05);
  EXPECT_DOUBLE_EQ(p_of(10, 0), 2.0 / 184756);  // 2 / C(20, 10)
  EXPECT_DOUBLE_EQ(p_of(4, 0), 2.0 / 70);
}

TEST(RankTest, ApproximationIsNearTheExactOne) {
  for (double shift : {0.0, 200.0, 400.0}) {
    const Sample a = values(20, 1, 1000), b = values(20, 2, 1000, shift);
    EXPECT_NEAR(rank_test(a, b).p, rank_test_normal(a, b).p, 0.01) << shift;
    const Sample c = values(20, 3, 5), d = values(20, 4, 5, shift / 400);
    EXPECT_NEAR(rank_test(c, d).p, rank_test_normal(c, d).p, 0.03) << "with ties, " << shift;
  }
  EXPECT_TRUE(rank_test(values(28, 1, 9), values(28, 2, 9)).exact);
  EXPECT_FALSE(rank_test(values(28, 1, 9), values(29, 2, 9)).exact);
  EXPECT_LT(rank_test(values(100, 1, 1000), values(100, 2, 1000, 500)).p, 1e-6);
}

TEST(RankTest, SwappingTheSidesMirrorsIt) {
  const Sample a = values(7, 3, 5), b = values(9, 4, 5, 1);
  const RankTest there = rank_test(a, b), back = rank_test(b, a);
  EXPECT_EQ(there.p, back.p);
  EXPECT_EQ(there.u + back.u, 63);
  EXPECT_DOUBLE_EQ(probability_lower(a, b) + probability_lower(b, a), 1);
  EXPECT_EQ(*median_shift(a, b), -*median_shift(b, a));
  EXPECT_EQ(rank_test_normal(a, b).p, rank_test_normal(b, a).p);
}

TEST(RankTest, NothingToTellApart) {
  EXPECT_EQ(rank_test({2, 2, 2}, {2, 2}).p, 1);
  EXPECT_EQ(rank_test_normal({2, 2, 2}, {2, 2}).p, 1);
  EXPECT_EQ(rank_test({1}, {2}).p, 1);
  EXPECT_EQ(probability_lower({2, 2, 2}, {2, 2}), 0.5);
  EXPECT_THROW(rank_test({}, {1}), std::invalid_argument);
  EXPECT_THROW(probability_lower({1}, {}), std::invalid_argument);
}

TEST(RankTest, FailedRunsAreTheWorst) {
  const Sample good{1, 2, 3, 4}, half{1.5, kNaN, 2.5, kInf};
  EXPECT_EQ(rank_test(good, half).p, rank_test(good, {1.5, 90, 2.5, 90}).p) << "equal to each other";
  EXPECT_EQ(probability_lower({kNaN}, {1}), 1);
  EXPECT_EQ(probability_lower({kNaN}, {kInf}), 0.5);
  EXPECT_EQ(median_shift(good, half), std::nullopt);
  EXPECT_EQ(median_shift(good, {}), std::nullopt);
}

TEST(RankTest, SmallestP) {
  EXPECT_DOUBLE_EQ(smallest_p(3, 3), 0.1);
  EXPECT_DOUBLE_EQ(smallest_p(4, 3), rank_test({1, 2, 3, 4}, {5, 6, 7}).p);
  EXPECT_DOUBLE_EQ(smallest_p(10, 10), 2.0 / 184756);
  EXPECT_EQ(smallest_p(1, 1), 1);
  EXPECT_EQ(smallest_p(0, 5), 1);
}

TEST(EffectSize, CountsPairs) {
  const Sample before{3, 5, 8}, after{1, 5, 9, 2};
  EXPECT_DOUBLE_EQ(probability_lower(before, after), 7.5 / 12)
      << "1 and 2 lower than all three (6), 5 lower than 8 and ties 5 (1.5), 9 lower than none";
  EXPECT_EQ(effect_size_name(0.5), "negligible");
  EXPECT_EQ(effect_size_name(0.573), "negligible");
  EXPECT_EQ(effect_size_name(0.574), "small");
  EXPECT_EQ(effect_size_name(0.66), "small");
  EXPECT_EQ(effect_size_name(0.736), "medium");
  EXPECT_EQ(effect_size_name(0.737), "large");  // |2 A12 - 1| is 0.474 to the last bit
  EXPECT_EQ(effect_size_name(0.426), "small");
  EXPECT_EQ(effect_size_name(0.67), "medium");
  EXPECT_EQ(effect_size_name(0.74), "large");
  EXPECT_EQ(effect_size_name(0), "large");
}

TEST(MedianShift, IsTheMedianOfAllDifferences) {
  for (unsigned seed = 1; seed < 60; ++seed) {
    const Sample a = values(1 + seed % 7, seed, 1000, -500),
                 b = values(1 + seed % 5, seed + 90, 1000, -480.25);
    Sample differences;
    for (double x : a)
      for (double y : b) differences.push_back(y - x);
    std::sort(differences.begin(), differences.end());
    const std::size_t n = differences.size();
    const double median = n % 2 == 1 ? differences[n / 2] : (differences[n / 2 - 1] + differences[n / 2]) / 2;
    EXPECT_EQ(*median_shift(a, b), median) << seed;
  }
  EXPECT_EQ(*median_shift({1}, {1}), 0);
}

TEST(Holm, StepsDown) {
  // 0.01 * 4, 0.02 * 3, then not below it: 0.03 * 2 = 0.06, 0.04 * 1 raised to 0.06.
  EXPECT_THAT(holm({0.04, 0.01, 0.03, 0.02}), ElementsAre(DoubleNear(0.06, 1e-15), DoubleNear(0.04, 1e-15),
                                                          DoubleNear(0.06, 1e-15), DoubleNear(0.06, 1e-15)));
  EXPECT_THAT(holm({0.9, 0.8}), ElementsAre(1, 1));
  EXPECT_THAT(holm({0.03}), ElementsAre(0.03));
  EXPECT_THAT(holm({}), ElementsAre());
}

// Ties of three and two: s^2 = 9 / 12 (7 - 30 / 30) = 4.5 and U = 6.5, so that z = 3 / sqrt(4.5) / 2 =
// sqrt(2) / 2.
TEST(RankTest, ApproximationByHand) {
  const RankTest test = rank_test_normal({1, 1, 2}, {1, 2, 3});
  EXPECT_EQ(test.u, 6.5);
  EXPECT_NEAR(test.p, std::erfc(0.5), 1e-15);
  EXPECT_FALSE(test.exact);
  // Without ties: s^2 = 8 / 12 * 7 = 14 / 3, U = 8.
  EXPECT_NEAR(rank_test_normal({1, 2, 3, 4}, {5, 6}).p, std::erfc(3.5 / std::sqrt(14.0 / 3) / std::sqrt(2.0)),
              1e-15);
}

TEST(MedianShift, DifferencesOfNothing) {
  EXPECT_EQ(*median_shift({5, 5.5}, {1, 5}), -2.25);  // of -4.5, -4, -0.5, 0
  EXPECT_EQ(*median_shift({1, 5}, {5, 5.5}), 2.25);
  EXPECT_EQ(*median_shift({1, 2, 3}, {1, 2, 3}), 0);
  EXPECT_EQ(*median_shift({1, 2}, {1, 2, 3}), 0.5);  // of -1, 0, 0, 1, 1, 2
}

}  // namespace
}  // namespace odobench
