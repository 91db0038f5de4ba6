#include "problems/simulation/raw_csv.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace odobench::simulate {
namespace {

// 2024-05-03 12:34:34, seconds since 1970 of the wall clock that the files were written by.
constexpr std::int64_t kFirstLog_s = 1'714'739'674;
constexpr std::int64_t kBetweenLogs_s = 180;
constexpr std::int64_t kBehindUtc_s = 7 * 3600;
constexpr std::int64_t kFirstSequence = 2014, kFirstWheelSequence = 21568;
constexpr std::int64_t kMillion = 1'000'000;
// Front-left is wheel 1, rear-left 2, rear-right 3, front-right 4; the files name them alphabetically.
constexpr std::array<std::size_t, kWheelCount> kFileOrder = {1, 2, 0, 3};

std::int64_t wall_us(int number, std::int64_t us) {
  return (kFirstLog_s + (number - 1) * kBetweenLogs_s) * kMillion + us;
}

// "2024/05/03/12:34:34.823195"; sets of up to a thousand recordings end within the month.
void append_time(std::string& text, std::int64_t wall) {
  constexpr std::int64_t day = 86'400, may_first_s = 1'714'521'600;
  const std::int64_t seconds = wall / kMillion, since = seconds - may_first_s, of_day = since % day;
  fmt::format_to(std::back_inserter(text), "2024/05/{:02d}/{:02d}:{:02d}:{:02d}.{:06d}", since / day + 1,
                 of_day / 3600, of_day / 60 % 60, of_day % 60, wall % kMillion);
}

// Header stamps are in UTC.
void append_stamp(std::string& text, std::int64_t wall) {
  fmt::format_to(std::back_inserter(text), "{};{}", wall / kMillion + kBehindUtc_s, wall % kMillion * 1000);
}

template <class Position, class Wheel>
void append_list(std::string& text, Position position, Wheel wheel) {
  text += ";(";
  for (std::size_t k = 0; k < kWheelCount; ++k)
    fmt::format_to(std::back_inserter(text), "{}{}, {}", k > 0 ? ", " : "", position(kFileOrder[k]),
                   wheel(kFileOrder[k]));
  text += ')';
}

}  // namespace

std::string capture_csv(const DriveLogs& logs, int number) {
  std::string text =
      "time;.header.seq;.header.stamp.secs;.header.stamp.nsecs;.header.frame_id;.pose.position.x;"
      ".pose.position.y;.pose.position.z;.pose.orientation.x;.pose.orientation.y;.pose.orientation.z;"
      ".pose.orientation.w\n";
  const auto out = std::back_inserter(text);
  for (const CaptureMessage& m : logs.capture) {
    append_time(text, wall_us(number, m.received_us));
    fmt::format_to(out, ";{};", kFirstSequence + m.sequence);
    append_stamp(text, wall_us(number, m.stamp_us));
    fmt::format_to(out, ";world;{};{};0;0;0;{};{}\n", m.pose.x, m.pose.y, std::sin(m.pose.theta / 2),
                   std::cos(m.pose.theta / 2));
  }
  return text;
}

std::string wheels_csv(const DriveLogs& logs, int number) {
  std::string text =
      "time;.header.seq;.header.stamp.secs;.header.stamp.nsecs;.header.frame_id;.name;.position;.velocity;"
      ".effort\n";
  std::int64_t sequence = kFirstWheelSequence;
  for (const WheelMessage& m : logs.wheels) {
    append_time(text, wall_us(number, m.received_us));
    fmt::format_to(std::back_inserter(text), ";{};", sequence++);
    append_stamp(text, wall_us(number, m.stamp_us));
    text +=
        ";;['BL_Position', 'BL_Wheel', 'BR_Position', 'BR_Wheel', 'FL_Position', 'FL_Wheel', 'FR_Position', "
        "'FR_Wheel']";
    append_list(
        text, [&](std::size_t i) { return m.steering[i]; }, [&](std::size_t i) { return m.angle[i]; });
    append_list(
        text, [](std::size_t) { return 0.0; }, [&](std::size_t i) { return m.speed[i]; });
    append_list(
        text, [](std::size_t) { return 0.0; }, [](std::size_t) { return 0.0; });
    text += '\n';
  }
  return text;
}

}  // namespace odobench::simulate
