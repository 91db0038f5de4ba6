// One drive of a robot on one clock: what its wheels said, and where it really was. Plain data in SI units
// and radians; the readers guarantee what is stated here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace odobench {

// What the entries of a signal say about the time between stamps. An entry of row j holds
//   Speed      from stamp j until stamp j + 1 (rad/s);
//   Increment  for the motion between stamps j - 1 and j (rad); that of the first row belongs to a time
//              before the recording and is never used;
//   Angle      at stamp j (rad), and until stamp j + 1 beside speeds, from stamp j - 1 beside increments.
enum class SignalKind { Speed, Increment, Angle };

struct Signal {
  std::string name;  // unique in the recording, e.g. "wheel.1", "steering.1"
  SignalKind kind = SignalKind::Speed;
  std::vector<double> values;  // one per stamp

  bool operator==(const Signal&) const = default;
};

// "rad/s" or "rad".
const char* unit_of(SignalKind kind);
// "speed", "increment", "angle".
const char* name_of(SignalKind kind);

// Where the robot really was: by motion capture at every stamp, by tape measure at the end only.
struct Reference {
  std::vector<std::size_t> sample;  // stamps of the entries, increasing; empty: every stamp
  std::vector<double> x, y;         // m
  std::vector<double> theta;        // rad, unwrapped

  bool operator==(const Reference&) const = default;
};

struct Recording {
  std::string id;                     // unique in its data set, e.g. "line_x_1"
  std::string trajectory;             // name of the driven trajectory, e.g. "line_x"
  int repetition = 0;                 // 1-based
  std::vector<std::int64_t> time_us;  // strictly increasing, starts at 0, microseconds
  std::vector<Signal> signals;
  Reference reference;

  std::size_t size() const { return time_us.size(); }
  // Nothing where no signal has the name.
  const Signal* find(std::string_view name) const;
};

}  // namespace odobench
