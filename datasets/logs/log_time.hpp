// Times of logs, written as text or numbers in whatever unit, as whole nanoseconds: a double of Unix time is
// exact to 2e-7 s only.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace odobench {

// How a column or field writes time.
class TimeUnit {
 public:
  // "s", "ms", "us", "ns"; "iso8601" (2026-01-31T12:00:00.5+02:00; T or a blank, Z, +02, +0200 or no zone,
  // which is UTC); else a pattern as of strptime: %Y %m %d %H %M %S %f (digits of a second's fraction) %j %b
  // %z %F %T %%. Throws std::invalid_argument for anything else.
  explicit TimeUnit(std::string unit);

  // Nanoseconds since 1970, or since whatever the log counts from, exact: nothing is rounded but what is
  // finer than 1 ns. Nothing where this is no time in this unit or is beyond +-4e18 ns.
  std::optional<std::int64_t> of(std::string_view text) const;
  std::optional<std::int64_t> of(std::int64_t number) const;
  std::optional<std::int64_t> of(double number) const;

  const std::string& name() const { return unit_; }
  // "a time in ms", "a time as \"%H:%M\"", for messages.
  std::string text() const;

 private:
  std::string unit_;
  int digits_ = -1;  // of a number: the unit is 10^digits ns
};

// "2026-01-31T12:00:00.123456789+02:00".
std::optional<std::int64_t> iso8601_nanoseconds(std::string_view text);

// What a name says of time: "s", "ms", "us" or "ns" of "Time (ms)", "t_us", "stamp_ns", "t [s]"; "" where it
// names no unit of time.
std::string time_unit_of_name(std::string_view name);
// "time", "stamp", "t", "Zeit [s]", or a unit of time in the name.
bool name_tells_time(std::string_view name);

// The unit of times that are not told: of 3 values at least that never go back. Texts of ISO 8601; numbers
// near Unix time of our days, else those whose median step is a rate of 1 to 1000 Hz in one unit only (1e6 ns
// and longer steps: ns). "" where nothing fits or two units do (a counter 0, 1, 2 is no time).
std::string time_unit_of_values(const std::vector<std::string>& values);

}  // namespace odobench
