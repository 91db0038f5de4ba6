// The two kinds of raw files of the vitko2024 recordings, as columns. Errors are DataErrors "file:line: ...".
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/error.hpp"
#include "datasets/recording.hpp"

namespace odobench::vitko2024 {

// Row k of either log stands on line k + 2 of its file, below the header line.
inline std::size_t line_of_row(std::size_t row) {
  return row + 2;
}

struct CaptureLog {
  std::vector<std::int64_t> time_us;  // since 1970-01-01 00:00 of the file's wall clock, as written
  std::vector<double> x, y;           // m
  std::vector<double> yaw;            // rad, in [-pi, pi], as atan2 gives it
};

struct WheelLog {
  std::vector<std::int64_t> time_us;
  std::array<std::vector<double>, kWheelCount> steering;     // rad
  std::array<std::vector<double>, kWheelCount> wheel_speed;  // rad/s
};

// text: the whole file; file: its name in messages.
CaptureLog parse_capture(std::string_view text, const std::string& file);
WheelLog parse_wheels(std::string_view text, const std::string& file);

// "2024/05/03/12:34:34.823195" -> microseconds since 1970-01-01 00:00 of the same clock; false when it is no
// such time.
bool parse_time(std::string_view text, std::int64_t& time_us);

}  // namespace odobench::vitko2024
