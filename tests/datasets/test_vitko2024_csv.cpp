// The raw files of the vitko2024 recordings, row by row (datasets/vitko2024_csv.hpp).
#include "datasets/import/vitko2024/vitko2024_csv.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/data_error.hpp"

namespace odobench {
namespace {

using testing::data_error;
using vitko2024::CaptureLog;
using vitko2024::parse_capture;
using vitko2024::parse_time;
using vitko2024::parse_wheels;
using vitko2024::WheelLog;

constexpr double kPi = std::numbers::pi;

TEST(Vitko2024Time, IsMicrosecondsOfTheClockAsWritten) {
  const auto time = [](const char* text) {
    std::int64_t us = -1;
    EXPECT_TRUE(parse_time(text, us)) << text;
    return us;
  };
  EXPECT_EQ(time("1970/01/01/00:00:00"), 0);
  EXPECT_EQ(time("1970/01/02/00:00:00.000001"), 86'400'000'001);
  EXPECT_EQ(time("2024/05/03/12:34:34.823195"),
            1'714'739'674'823'195);  // date -u -d "2024-05-03 12:34:34" +%s
  EXPECT_EQ(time("2024/02/29/23:59:59.5"), 1'709'251'199'500'000);
  EXPECT_EQ(time("2024/02/29/23:59:59.05"), 1'709'251'199'050'000);
  EXPECT_EQ(time("2024/12/31/09:08:07.98765"), 1'735'636'087'987'650);
}

TEST(Vitko2024Time, RefusesEverythingElse) {
  std::int64_t us = 7;
  EXPECT_TRUE(parse_time("2024/05/03/12:34:34.823195", us));
  for (const char* text : {"",
                           "2024/05/03",
                           "2024/05/03/12:34:3",
                           "2024-05/03/12:34:34",
                           "2024/05-03/12:34:34",
                           "2024/05/03 12:34:34",
                           "2024/05/03/12-34:34",
                           "2024/05/03/12:34-34",
                           "2024/05/03/12:34:34.",
                           "2024/05/03/12:34:34,5",
                           "2024/05/03/12:34:34.1234567",
                           "2024/05/03/12:34:34.12x",
                           "2024/05/03/12:34:34.12 ",
                           "2024/00/03/12:34:34",
                           "2024/13/03/12:34:34",
                           "2024/05/00/12:34:34",
                           "2024/05/32/12:34:34",
                           "2023/02/29/12:34:34",
                           "2024/05/03/24:00:00",
                           "2024/05/03/23:60:00",
                           "2024/05/03/23:59:60",
                           "x024/05/03/12:34:34",
                           "2024/0x/03/12:34:34",
                           "2024/05/0:/12:34:34",
                           "2024/05/03/1/:34:34",
                           "2024/05/03/12:3x:34",
                           "2024/05/03/12:34:x4"})
    EXPECT_FALSE(parse_time(text, us)) << text;
}

// A file with rows of a position and an orientation.
std::string capture(const std::vector<std::string>& rows) {
  std::string text =
      "time;.pose.position.x;.pose.position.y;.pose.orientation.x;.pose.orientation.y;.pose.orientation.z;"
      ".pose.orientation.w\n";
  for (std::size_t k = 0; k < rows.size(); ++k)
    text += fmt::format("1970/01/01/00:00:{:02};{}\n", k, rows[k]);
  return text;
}

TEST(Vitko2024Capture, TheHeadingIsTheYawOfTheQuaternion) {
  const auto yaw = [](double x, double y, double z, double w) {
    return parse_capture(capture({fmt::format("0;0;{};{};{};{}", x, y, z, w)}), "f").yaw.at(0);
  };
  EXPECT_EQ(yaw(0, 0, 0, 1), 0);
  EXPECT_NEAR(yaw(0, 0, std::sin(0.4), std::cos(0.4)), 0.8, 1e-15);
  EXPECT_EQ(yaw(1, 0, 0, 0), 0);                // on its head
  EXPECT_EQ(yaw(0, 1, 0, 0), kPi);              // over its back
  EXPECT_EQ(yaw(0.5, 0.5, 0.5, 0.5), kPi / 2);  // on its side
  EXPECT_NEAR(yaw(0.6, 0.8, 0, 0), std::atan2(0.96, -0.28), 1e-15);
  EXPECT_NEAR(yaw(0, 0.6, 0.8, 0), kPi, 1e-15);  // 1 - 2 (0.36 + 0.64)
}

TEST(Vitko2024Capture, RowsBecomeColumns) {
  const CaptureLog log = parse_capture(capture({"1;2;0;0;0;1", "-3.5;4e-1;0;0;1;0"}), "f");
  EXPECT_EQ(log.time_us, (std::vector<std::int64_t>{0, 1'000'000}));
  EXPECT_EQ(log.x, (std::vector<double>{1, -3.5}));
  EXPECT_EQ(log.y, (std::vector<double>{2, 0.4}));
  EXPECT_EQ(log.yaw, (std::vector<double>{0, kPi}));
  EXPECT_EQ(log.lines.header, 1u);
  EXPECT_EQ(log.lines.rows, (std::vector<std::size_t>{2, 3}));
  EXPECT_EQ(log.lines.end(), 4u);
  EXPECT_FALSE(log.lines.unfinished);
  EXPECT_EQ(log.lost, 0u);
}

TEST(Vitko2024Capture, OrientationsAreOfNormOneWithinATenth) {
  for (const char* w : {"1.0999", "0.9001", "-1.0999"})
    EXPECT_EQ(parse_capture(capture({fmt::format("0;0;0;0;0;{}", w)}), "f").x.size(), 1u) << w;
  for (const char* w : {"1.1001", "0.8999", "0", "-1.1001"}) {
    const std::string text = capture({fmt::format("0;0;0;0;0;{}", w), "0;0;0;0;0;1"});
    EXPECT_NE(
        data_error([&] { parse_capture(text, "f"); })
            .find(fmt::format("f:2: found an orientation quaternion of norm {:.4g}, expected 1 (within 0.1)",
                              std::abs(std::stod(w)))),
        std::string::npos)
        << w;
    const CaptureLog log = parse_capture(text, "f", true);
    EXPECT_EQ(log.lost, 1u);
    EXPECT_EQ(log.time_us, std::vector<std::int64_t>{1'000'000});
    EXPECT_EQ(log.lines.rows, std::vector<std::size_t>{3});
  }
}

TEST(Vitko2024Capture, OnlyNotANumberIsLostAmongTheFields) {
  for (const char* row : {"nan;0;0;0;0;1", "0;NaN;0;0;0;1", "0;0;0;0;0;NAN"}) {
    EXPECT_EQ(parse_capture(capture({row}), "f", true).lost, 1u) << row;
    EXPECT_NE(data_error([&] { parse_capture(capture({row}), "f"); }), "") << row;
  }
  EXPECT_EQ(parse_capture(capture({"0.5;1.5;0.6;0.8;0.0;0.0"}), "f", true).lost, 0u);
  for (const char* field : {"na", "nanx", "nam", "nbn", "xan", ""})
    EXPECT_EQ(
        data_error([&] { parse_capture(capture({fmt::format("{};0;0;0;0;1", field)}), "f", true); }),
        fmt::format("f:2: found \"{}\" in column \".pose.position.x\", expected a finite number", field));
}

constexpr const char* kNames =
    "['FL_Position', 'BL_Position', 'BR_Position', 'FR_Position', 'FL_Wheel', 'BL_Wheel', 'BR_Wheel', "
    "'FR_Wheel']";

std::string wheels(const std::vector<std::string>& rows) {
  std::string text = "time;.name;.position;.velocity\n";
  for (std::size_t k = 0; k < rows.size(); ++k)
    text += fmt::format("1970/01/01/00:00:{:02};{}\n", k, rows[k]);
  return text;
}

std::string error_of_names(const std::string& names) {
  return data_error([&] { parse_wheels(wheels({names + ";(1,2,3,4,5,6,7,8);(1,2,3,4,5,6,7,8)"}), "f"); });
}

TEST(Vitko2024Wheels, NamesSayWhereTheNumbersStand) {
  const std::string numbers = ";(1, 2, 3, 4, 5, 6, 7, 8);[11,12,13,14,15,16,17,18]";
  // In the second row the names stand the other way round, without quotes.
  const WheelLog log = parse_wheels(
      wheels(
          {kNames + numbers,
           "(FR_Wheel,BR_Wheel,BL_Wheel,FL_Wheel,FR_Position,BR_Position,BL_Position,FL_Position)" + numbers,
           kNames + numbers}),
      "f");
  for (std::size_t i = 0; i < kWheelCount; ++i) {
    const auto w = static_cast<double>(i);
    EXPECT_EQ(log.steering[i], (std::vector<double>{1 + w, 8 - w, 1 + w}));
    EXPECT_EQ(log.wheel_speed[i], (std::vector<double>{15 + w, 14 - w, 15 + w}));
  }
  EXPECT_EQ(log.time_us, (std::vector<std::int64_t>{0, 1'000'000, 2'000'000}));
  EXPECT_EQ(log.lines.rows, (std::vector<std::size_t>{2, 3, 4}));
  EXPECT_EQ(log.lines.header, 1u);
}

TEST(Vitko2024Wheels, RefusesOtherNames) {
  const auto with_first = [](const std::string& name) {
    return testing::replaced(kNames, "'FL_Position'", name);
  };
  EXPECT_EQ(error_of_names(kNames), "");
  EXPECT_EQ(error_of_names(with_first("\"FL_Position\"")), "");
  const std::string unknown = "f:2: found the unknown wheel name \"";
  const std::string expected = "\", expected FL, BL, BR or FR with _Position or _Wheel";
  for (const char* name :
       {"'FL_Position", "FL_Position'", "'FL_Position\"", "FL_Positions", "FL", "XX_Position", "'"})
    EXPECT_EQ(error_of_names(with_first(name)), unknown + name + expected);
  EXPECT_EQ(error_of_names(with_first("''")), unknown + expected);
  EXPECT_EQ(error_of_names(with_first("'BL_Position'")),
            "f:2: found the wheel name \"BL_Position\" twice, expected it once");
  EXPECT_EQ(error_of_names(testing::replaced(kNames, "'FL_Position', ", "")),
            "f:2: found no name \"FL_Position\", expected all eight");
  EXPECT_EQ(error_of_names(testing::replaced(kNames, ", 'FR_Wheel'", "")),
            "f:2: found no name \"FR_Wheel\", expected all eight");
}

TEST(Vitko2024Wheels, RefusesOtherLists) {
  const auto error = [](const std::string& positions) {
    return data_error(
        [&] { parse_wheels(wheels({kNames + (";" + positions) + ";(1,2,3,4,5,6,7,8)"}), "f"); });
  };
  EXPECT_EQ(error(" [1,2,3,4,5,6,7,8] "), "");
  const std::string expected = " in column \".position\", expected a list like (0.0, 1.0)";
  for (const char* list : {"(", "[1,2,3,4,5,6,7,8)", "(1,2,3,4,5,6,7,8]", "1", "(1,2,3,4,5,6,7,8", "1,2)"})
    EXPECT_EQ(error(list), fmt::format("f:2: found \"{}\"{}", list, expected));
  EXPECT_EQ(error(""), "f:2: found nothing" + expected);
  EXPECT_EQ(error("[]"), "f:2: found 0 entries in column \".position\", expected 8 as there are names");
  EXPECT_EQ(error("( )"), "f:2: found 0 entries in column \".position\", expected 8 as there are names");
  EXPECT_EQ(error("(1)"), "f:2: found 1 entries in column \".position\", expected 8 as there are names");
  EXPECT_EQ(error("(1,2,3,4,5,6,7,8,9)"),
            "f:2: found 9 entries in column \".position\", expected 8 as there are names");
  EXPECT_EQ(error("(1,2,3,4,5,6,7,)"), "f:2: found \"\" in column \".position\", expected a finite number");
}

}  // namespace
}  // namespace odobench
