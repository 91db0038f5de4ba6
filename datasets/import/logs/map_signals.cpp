#include "datasets/import/logs/map_signals.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/angle.hpp"
#include "base/names.hpp"
#include "base/text.hpp"

namespace odobench::log_import {

using csv_import::NeededSignal;
using Kind = SignalFormat::Kind;

MappedField read_field(const JsonNode& node, const std::string& target, const LogMap& map) {
  std::vector<std::string> names;
  for (const MappedSource& source : map.sources) names.push_back(source.name);
  MappedField field;
  field.target = target;
  if (!node.has("source") && names.size() == 1)
    field.source = names.front();
  else
    field.source = node.at("source").text();
  if (std::find(names.begin(), names.end(), field.source) == names.end())
    node.at("source").fail(fmt::format("\"{}\"{}", shown(field.source), did_you_mean(field.source, names)),
                           fmt::format("one of /sources: {}", fmt::join(names, ", ")));
  if (node.has("field") == node.has("quaternion"))
    node.fail("field and quaternion, or neither", "one of them");
  if (node.has("field"))
    field.field = node.at("field").text();
  else
    field.quaternion = node.at("quaternion").text();
  if (field.field.empty() && field.quaternion.empty()) node.fail("an empty path", "that of a number");
  if (node.has("sign")) {
    const std::int64_t sign = node.at("sign").integer();
    if (sign != 1 && sign != -1) node.at("sign").fail(fmt::format("{}", sign), "1 or -1");
    field.scale = static_cast<double>(sign);
  }
  if (node.has("offset")) field.add = node.at("offset").number();
  if (node.has("optional")) field.optional = node.at("optional").boolean();
  return field;
}

MappedField read_other(const JsonNode& node, const std::string& target, const LogMap& map) {
  struct Unit {
    const char *target, *name;
    double scale;
  };
  static constexpr std::array<Unit, 10> units = {{{"gyro.", "rad/s", 1},
                                                  {"gyro.", "deg/s", kDegree},
                                                  {"accel.", "m/s^2", 1},
                                                  {"accel.", "g", 9.80665},
                                                  {"camera.heading", "rad", 1},
                                                  {"camera.heading", "deg", kDegree},
                                                  {"camera.x", "m", 1},
                                                  {"camera.x", "mm", 1e-3},
                                                  {"camera.y", "m", 1},
                                                  {"camera.y", "mm", 1e-3}}};
  csv_import::allow_only(node, {"source", "field", "quaternion", "unit", "sign", "offset", "optional"});
  MappedField field = read_field(node, target, map);
  std::vector<std::string> known;
  for (const Unit& unit : units) {
    if (!target.starts_with(unit.target)) continue;
    if (known.empty() ? !node.has("unit") : false) return field;  // in the first, which is SI
    known.emplace_back(unit.name);
    if (node.has("unit") && node.at("unit").text() == unit.name) {
      field.scale *= unit.scale;
      return field;
    }
  }
  if (known.empty())
    node.fail(fmt::format("a signal \"{}\"", shown(target)),
              "gyro.x, .y, .z, accel.x, .y, .z, camera.x, .y or .heading");
  node.at("unit").fail('"' + shown(node.at("unit").text()) + '"', fmt::format("{}", fmt::join(known, ", ")));
}

SignalReader::SignalReader(const JsonNode& signals, LogMap& map)
    : node_(signals), map_(map), needed_(csv_import::needed_signals(map.robot)) {}

// "wheel_angle.left" is "wheel.left"; of the one drive of a robot any name is.
const NeededSignal& SignalReader::needed(const std::string& key) const {
  const std::size_t dot = key.find('.');
  const std::string head = key.substr(0, dot), wheel = dot == std::string::npos ? "" : key.substr(dot + 1);
  const bool steering = head == "steering";
  const bool drive =
      head == "wheel_angle" || head == "wheel_speed" || head == "wheel_travel" || head == "wheel";
  const auto of_kind = [&](bool wanted) {
    return std::count_if(needed_.begin(), needed_.end(),
                         [&](const NeededSignal& s) { return s.steering == wanted; });
  };
  std::vector<std::string> names;
  for (const NeededSignal& s : needed_) {
    names.push_back(s.steering ? s.name
                               : "wheel_angle" + s.name.substr(std::min<std::size_t>(5, s.name.size())));
    if (key == s.name) return s;
    if ((steering || drive) && s.steering == steering &&
        (s.name == (steering ? "steering." : "wheel.") + wheel || of_kind(steering) == 1))
      return s;
  }
  node_.fail(fmt::format("a signal \"{}\" that the robot has not{}", shown(key), did_you_mean(key, names)),
             fmt::format("reference.x, .y, .heading, {} (or wheel_speed, wheel_travel), gyro.z, accel.x",
                         fmt::join(names, ", ")));
}

MappedSignal SignalReader::read(const std::string& key, const NeededSignal& needed) const {
  const JsonNode node = node_.at(key);
  csv_import::allow_only(node, {"source", "field", "kind", "unit", "per_turn", "gear", "bits", "wrap", "sign",
                                "offset", "radius", "optional"});
  MappedSignal signal;
  signal.at = read_field(node, needed.name, map_);
  signal.at.scale = 1;  // the sign stands in the format
  const Kind usual = needed.steering                   ? Kind::Angle
                     : key.starts_with("wheel_speed")  ? Kind::Speed
                     : key.starts_with("wheel_travel") ? Kind::Travel
                                                       : Kind::Position;
  signal.format = read_signal_kind(node, usual);
  signal.format.name = needed.name;
  if (node.has("gear")) {
    const double gear = node.at("gear").number();
    if (!(gear >= 1e-6 && gear <= 1e6)) node.at("gear").fail(fmt::format("{}", gear), "a number above 0");
    signal.format.scale /= gear;
  }
  if (node.has("wrap")) {
    const double bits = std::log2(node.at("wrap").number());
    if (node.has("bits") || signal.format.unit != "count" || bits != std::round(bits) || bits < 4 ||
        bits > 52)
      node.at("wrap").fail(fmt::format("{}", node.at("wrap").number()),
                           "a power of 2, of counts, and no bits beside it");
    signal.format.bits = static_cast<int>(bits);
  }
  if (needed.steering && signal.format.unit == "count") signal.half_count = 0.5;
  if (needed.steering != (signal.format.signal_kind() == SignalKind::Angle))
    node.fail(needed.steering ? "a steering signal that is no angle" : "a wheel's signal that is an angle",
              needed.steering ? "an angle" : "a position, increment, speed or travel");
  return signal;
}

void SignalReader::take(const std::string& key) {
  found_.push_back({key, read(key, needed(key))});
}

void SignalReader::finish() {
  for (const NeededSignal& wanted : needed_) {
    const Found* best = nullptr;
    for (const Found& found : found_)
      if (found.signal.format.name == wanted.name &&
          (best == nullptr || best->signal.format.kind == Kind::Speed))
        best = &found;
    if (best == nullptr) {
      std::vector<std::string> names;
      for (const NeededSignal& s : needed_) names.push_back(s.name);
      node_.fail(fmt::format("no signal for \"{}\"", shown(wanted.name)),
                 fmt::format("all of the robot: {}", fmt::join(names, ", ")));
    }
    map_.signals.push_back(best->signal);
  }
}

}  // namespace odobench::log_import
