// How a set.json of schema 2 states a signal, and the signal that comes of it: SI units, speeds, increments
// or angles.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/json_node.hpp"
#include "datasets/recording.hpp"

namespace odobench {

// kind       column holds                                                           becomes
// speed      rad/s, rpm, deg/s or turn/s, from its stamp to the next                speed
// increment  rad, deg, turn or count of the motion since the stamp before           increment
// angle      rad, deg or turn of a steering sensor                                  angle
// position   rad, deg, turn or count since some time: of a drive that only grows    increment
//            or shrinks; counts of `bits` bits run over from 2^bits - 1 to 0
// travel     m, cm or mm of the wheel's path since some time, at the radius `radius`          increment
// `per_turn`: counts of a turn of the wheel, or of the steering (motor counts times gear). `sign`: -1 where
// the sensor counts backwards.
struct SignalFormat {
  enum class Kind { Speed, Increment, Angle, Position, Travel };
  std::string name;
  Kind kind = Kind::Speed;
  std::string unit;
  double scale = 1;  // to rad/s or rad, sign included
  int bits = 0;      // 0: does not run over

  // What becomes of it.
  SignalKind signal_kind() const;
  // The column is the signal as it stands.
  bool plain() const;
};

SignalFormat read_signal_format(const JsonNode& node);
// The same without a name, of a node that may have other keys beside; `otherwise`: its kind where it states
// none.
SignalFormat read_signal_kind(const JsonNode& node,
                              std::optional<SignalFormat::Kind> otherwise = std::nullopt);
SignalFormat format_of(const Signal& signal);

// The first entry that a counter of so many bits, signed or not, cannot hold.
std::optional<std::size_t> beyond_counter(const SignalFormat& format, const std::vector<double>& values);

// Turns the column into the signal in place. A counter of n bits that runs over is read as the shorter way
// round: right as long as it moves by less than 2^(n - 1) between two stamps.
void convert(const SignalFormat& format, std::vector<double>& values);

}  // namespace odobench
