#include "datasets/logs/log_time.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/support/data_error.hpp"

namespace odobench {
namespace {

using testing::says;
using testing::usage_error;

std::optional<std::int64_t> as(const std::string& unit, const std::string& text) {
  return TimeUnit(unit).of(std::string_view(text));
}

TEST(LogTime, NumbersAreExact) {
  EXPECT_EQ(as("s", "1760000000.123456789"), 1760000000123456789);
  EXPECT_EQ(as("s", "1760000000,123456789"), 1760000000123456789);
  EXPECT_EQ(as("ms", "137.171"), 137171000);
  EXPECT_EQ(as("us", "1760000000000234"), 1760000000000234000);
  EXPECT_EQ(as("ns", "1760000000000234284"), 1760000000000234284);
  EXPECT_EQ(as("s", "1.76e9"), 1760000000000000000);
  EXPECT_EQ(as("s", "-0.000000001"), -1);
  EXPECT_EQ(as("s", "0.0000000005"), 1);  // finer than 1 ns: rounded
  EXPECT_EQ(as("s", "4e9"), 4000000000000000000);
  for (const char* bad : {"", "x", "1.2.3", "4.1e9", "1 2", "nan", "--1", "."})
    EXPECT_FALSE(as("s", bad)) << bad;
  EXPECT_EQ(TimeUnit("us").of(std::int64_t{1760000000000234}), 1760000000000234000);
  EXPECT_FALSE(TimeUnit("s").of(std::int64_t{1} << 62));
  EXPECT_EQ(TimeUnit("s").of(12.25), 12250000000);
  EXPECT_EQ(TimeUnit("ms").of(0.1), 100000);
  EXPECT_FALSE(TimeUnit("s").of(1e300));
  EXPECT_FALSE(TimeUnit("s").of(std::nan("")));
}

TEST(LogTime, Iso8601) {
  EXPECT_EQ(iso8601_nanoseconds("1970-01-01T00:00:00Z"), 0);
  EXPECT_EQ(iso8601_nanoseconds("2025-10-09T08:53:20Z"), 1760000000000000000);
  EXPECT_EQ(iso8601_nanoseconds("2025-10-09 08:53:20.123456789"), 1760000000123456789);
  EXPECT_EQ(iso8601_nanoseconds("2025-10-09T10:53:20,5+02:00"), 1760000000500000000);
  EXPECT_EQ(iso8601_nanoseconds("2025-10-09T10:53:20+0200"), 1760000000000000000);
  EXPECT_EQ(iso8601_nanoseconds("2025-10-09T03:23:20-05:30"), 1760000000000000000);
  EXPECT_EQ(iso8601_nanoseconds("2024-02-29T00:00Z"), 1709164800000000000);
  for (const char* bad : {"2025-02-29T00:00:00Z", "2025-13-01", "2025-10-09T25:00:00", "2025-10-09T08:53:20x",
                          "10.5", "", "2025-10-09T", "9999-01-01T00:00:00Z", "2025-10-09T08:53:20+99:00"})
    EXPECT_FALSE(iso8601_nanoseconds(bad)) << bad;
}

TEST(LogTime, Patterns) {
  EXPECT_EQ(as("%Y/%m/%d/%H:%M:%S.%f", "2025/10/09/08:53:20.000000001"), 1760000000000000001);
  EXPECT_EQ(as("%d %b %Y %T", "9 Oct 2025 08:53:20"), 1760000000000000000);
  EXPECT_EQ(as("%F %T%z", "2025-10-09 10:53:20+0200"), 1760000000000000000);
  EXPECT_EQ(as("%Y-%j", "1970-032"), std::int64_t{31} * 86400 * 1000000000);
  EXPECT_EQ(as("%H:%M:%S.%f", "00:01:02.5"), 62500000000);
  EXPECT_FALSE(as("%H:%M:%S.%f", "00:01:02.5 "));
  EXPECT_FALSE(as("%H:%M", "24:00"));
  EXPECT_TRUE(says(usage_error([] { TimeUnit("minutes"); }), {"time_unit", "minutes", "iso8601"}));
  EXPECT_TRUE(says(usage_error([] { TimeUnit("%Q"); }), {"%Q", "expected %Y"}));
  EXPECT_TRUE(says(usage_error([] { TimeUnit("%H:%"); }), {"expected %Y"}));
}

TEST(LogTime, UnitsOfNames) {
  const std::vector<std::pair<std::string, std::string>> units{
      {"time [ms]", "ms"},     {"stamp_ns", "ns"},  {"t_us", "us"},        {"Time (s)", "s"},
      {"Zeit [s]", "s"},       {"time", ""},        {"links [1/min]", ""}, {"x [m]", ""},
      {"t (\xC2\xB5s)", "us"}, {"speed [m/s]", ""}, {"millis", "ms"},      {"#timestamp [ns]", "ns"}};
  for (const auto& [name, unit] : units) EXPECT_EQ(time_unit_of_name(name), unit) << name;
  for (const char* name : {"t", "time", "stamp", "timestamp", "Zeit", "t_us", "header.stamp"})
    EXPECT_TRUE(name_tells_time(name)) << name;
  for (const char* name : {"x", "left", "count", "yaw [deg]", "speed [m/s]"})
    EXPECT_FALSE(name_tells_time(name)) << name;
}

TEST(LogTime, UnitsOfValues) {
  EXPECT_EQ(time_unit_of_values({"1760000000.004", "1760000000.024", "1760000000.044"}), "s");
  EXPECT_EQ(time_unit_of_values({"1760000000000", "1760000000010", "1760000000020"}), "ms");
  EXPECT_EQ(time_unit_of_values({"1760000000000234", "1760000000025234", "1760000000050234"}), "us");
  EXPECT_EQ(time_unit_of_values({"1760000000000234284", "1760000000024823389", "1760000000050013861"}), "ns");
  EXPECT_EQ(time_unit_of_values({"0,00", "0,02", "0,04"}), "s");
  EXPECT_EQ(time_unit_of_values({"0", "20", "40"}), "ms");
  EXPECT_EQ(time_unit_of_values({"0", "20000", "40000"}), "us");
  EXPECT_EQ(time_unit_of_values({"0", "20000000", "40000000"}), "ns");
  EXPECT_EQ(time_unit_of_values({"2025-10-09T08:53:20Z", "2025-10-09T08:53:21Z"}), "iso8601");
  EXPECT_EQ(time_unit_of_values({"0", "1", "2"}), "");       // a counter
  EXPECT_EQ(time_unit_of_values({"0", "0.1", "0.05"}), "");  // goes back
  EXPECT_EQ(time_unit_of_values({"0.1", "0.2"}), "");        // too few
  EXPECT_EQ(time_unit_of_values({"a", "b", "c"}), "");
  EXPECT_EQ(time_unit_of_values({}), "");
}

}  // namespace
}  // namespace odobench
