// The two kinds of raw files of the vitko2024 recordings, as columns. Errors are DataErrors "file:line: ...".
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"
#include "datasets/robot_4wis4wid.hpp"

namespace odobench::vitko2024 {

// Where the rows of a log stand in their file.
struct RowLines {
  std::size_t header = 1;
  std::vector<std::size_t> rows;
  bool unfinished = false;  // the last line had all its fields, but no line break
  std::size_t end() const { return (rows.empty() ? header : rows.back()) + 1; }
};

struct CaptureLog {
  std::vector<std::int64_t> time_us;  // since 1970-01-01 00:00 of the file's wall clock, as written
  std::vector<double> x, y;           // m
  std::vector<double> yaw;            // rad, in [-pi, pi], as atan2 gives it
  RowLines lines;
  std::size_t lost = 0;  // samples left out
};

struct WheelLog {
  std::vector<std::int64_t> time_us;
  std::array<std::vector<double>, kWheelCount> steering;     // rad
  std::array<std::vector<double>, kWheelCount> wheel_speed;  // rad/s
  RowLines lines;
};

// text: the whole file; file: its name in messages.
// drop_lost: samples whose tracking was lost (an orientation that is no rotation, or not-a-number) are left
// out and counted instead of refused.
CaptureLog parse_capture(std::string_view text, const std::string& file, bool drop_lost = false);
WheelLog parse_wheels(std::string_view text, const std::string& file);

// "2024/05/03/12:34:34.823195" -> microseconds since 1970-01-01 00:00 of the same clock; false when it is no
// such time.
bool parse_time(std::string_view text, std::int64_t& time_us);

}  // namespace odobench::vitko2024
