#include "datasets/recording.hpp"

#include <algorithm>

namespace odobench {

const char* unit_of(SignalKind kind) {
  return kind == SignalKind::Speed ? "rad/s" : "rad";
}

const char* name_of(SignalKind kind) {
  switch (kind) {
    case SignalKind::Speed:
      return "speed";
    case SignalKind::Increment:
      return "increment";
    case SignalKind::Angle:
      break;
  }
  return "angle";
}

const Signal* Recording::find(std::string_view name) const {
  const auto found =
      std::find_if(signals.begin(), signals.end(), [&](const Signal& signal) { return signal.name == name; });
  return found == signals.end() ? nullptr : &*found;
}

}  // namespace odobench
