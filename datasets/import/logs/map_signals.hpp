// The signals of a map.json: from names that people use to those of the robot.
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "base/json_node.hpp"
#include "datasets/import/csv/csv_map.hpp"
#include "datasets/import/logs/log_map.hpp"

namespace odobench::log_import {

// Source, field or quaternion, sign and offset of a value; the source may be left out where there is one.
MappedField read_field(const JsonNode& node, const std::string& target, const LogMap& map);
// "gyro.z" (rad/s, deg/s), "accel.x" (m/s^2, g), "camera.x" (m, ...), "camera.heading" (rad, deg).
MappedField read_other(const JsonNode& node, const std::string& target, const LogMap& map);

// Reads all signals of the robot out of the object `signals`. A drive is "wheel_angle.W", "wheel_speed.W",
// "wheel_travel.W" or, with a kind, the robot's own name; W is what follows "wheel." in that name, or
// anything for the one wheel of a tricycle. A steering angle is "steering.W" likewise.
class SignalReader {
 public:
  SignalReader(const JsonNode& signals, LogMap& map);
  // Reads the member of this name.
  void take(const std::string& key);
  // Puts the signals into the map; refuses missing ones. An angle goes before a speed of the same wheel.
  void finish();

 private:
  struct Found {
    std::string key;
    MappedSignal signal;
  };
  const csv_import::NeededSignal& needed(const std::string& key) const;
  MappedSignal read(const std::string& key, const csv_import::NeededSignal& needed) const;

  JsonNode node_;
  LogMap& map_;
  std::vector<csv_import::NeededSignal> needed_;
  std::vector<Found> found_;
};

}  // namespace odobench::log_import
