// What sensors that are no wheels measured during drives, by the recordings' clocks: a gyro, a camera.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace odobench {

// What a gyro said while the robot stood, before, between and after drives.
struct Standing {
  double mean = 0, deviation = 0;  // rad/s
  double seconds = 0;
};

// "gyro" has the column yaw_rate (rad/s, counter-clockwise), "camera" has x, y (m) and heading (rad): the
// robot's pose as the camera tells it, from the reference's first pose on.
struct SensorRows {
  std::string name;
  std::vector<std::string> columns;
  std::vector<std::int64_t> time_us;        // strictly increasing; 0 is the recording's first stamp
  std::vector<std::vector<double>> values;  // by column
  double delay_s = 0;                       // from stamp to arrival, the usual one
  std::optional<Standing> standing;
};

using SetSensors = std::map<std::string, std::vector<SensorRows>>;  // by recording id

}  // namespace odobench
