#include "datasets/import/vitko2024/synchronise.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "datasets/import/vitko2024/vitko2024_csv.hpp"

namespace odobench {
namespace {

TEST(ParseTime, CountsMicroseconds) {
  std::int64_t a = 0, b = 0;
  ASSERT_TRUE(vitko2024::parse_time("1970/01/02/00:00:00.000001", a));
  EXPECT_EQ(a, 86'400'000'001);
  ASSERT_TRUE(vitko2024::parse_time("2024/05/03/12:34:34.823195", a));
  EXPECT_EQ(a, 1'714'739'674'823'195);
  ASSERT_TRUE(vitko2024::parse_time("2024/02/29/23:59:59.999999", a));
  ASSERT_TRUE(vitko2024::parse_time("2024/03/01/00:00:00", b));
  EXPECT_EQ(b - a, 1);
  ASSERT_TRUE(vitko2024::parse_time("2024/03/01/00:00:00.25", a));
  EXPECT_EQ(a - b, 250'000);
  for (const char* bad : {"", "2023/02/29/00:00:00.0", "2024/13/01/00:00:00.0", "2024/01/01/24:00:00.0",
                          "2024/01/01/00:60:00", "2024/01/01/00:00:00.", "2024/01/01/00:00:00.1234567",
                          "2024/01/01 00:00:00.0", "2024/01/01/00:00:0x.0"})
    EXPECT_FALSE(vitko2024::parse_time(bad, a)) << bad;
}

TEST(Synchronise, UnwrapKeepsTheFirstAngleAndJoinsTheRest) {
  std::vector<double> angles, expected;
  for (int k = 0; k < 60; ++k) {
    expected.push_back(2 + (k < 30 ? -0.9 * k : -0.9 * 30 + 0.7 * (k - 30)));
    angles.push_back(std::remainder(expected.back(), 2 * std::numbers::pi));
  }
  unwrap(angles);
  for (std::size_t k = 0; k < angles.size(); ++k) EXPECT_NEAR(angles[k], expected[k], 1e-12) << k;
}

TEST(Synchronise, InterpolatesExactlyAtTheStampsAndLinearlyElsewhere) {
  const std::vector<std::int64_t> time = {0, 10, 30, 31}, at = {-10, 0, 5, 10, 20, 30, 31, 33};
  const std::vector<double> value = {0.1, 0.3, -0.7, 5};
  const std::vector<double> out = interpolate(time, value, at);
  const double expected[] = {-0.1, 0.1, 0.2, 0.3, -0.2, -0.7, 5, 16.4};
  for (std::size_t k = 0; k < at.size(); ++k) EXPECT_NEAR(out[k], expected[k], 1e-14) << at[k];
  EXPECT_EQ(out[1], value[0]);
  EXPECT_EQ(out[3], value[1]);
  EXPECT_EQ(out[5], value[2]);
  EXPECT_EQ(out[6], value[3]);
}

}  // namespace
}  // namespace odobench
