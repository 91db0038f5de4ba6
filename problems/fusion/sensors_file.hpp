// The sensors of `bench fuse` as a JSON file; docs/fusion.md describes it:
//   {"seed": 1, "wheels": {"sigma_velocity", "sigma_yaw_rate"}, "start": {"sigma_position", "sigma_heading"},
//    "sensors": [{"name", "type": "pose|heading|relative_pose|yaw_rate", "rate_hz", "delay_s", "missing",
//                 "errors": {what the synthetic device does}, "filter": {what the filter believes}}, ...]
//     (measured: "file": "gyro_{recording}.csv", "columns", "unit", "standing" instead of rate_hz, errors),
//    "gyro_bias": {"initial", "walk"}, "odometry_scale": {...}, "gate_probability", "max_delay_s",
//    "unscented": {"alpha", "beta", "kappa"}}
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "problems/fusion/fusion.hpp"
#include "problems/fusion/sensor_streams.hpp"

namespace odobench {

struct SyntheticSensor {
  SensorStream stream;  // what the filter believes; without data
  // Measured, not synthetic: a table per recording, "{recording}" in its name standing for the id, relative
  // to the sensors' file. Columns by what they are: time, yaw_rate, x, y, heading.
  std::string file;
  std::map<std::string, std::string> columns;
  double rate_scale = 1, heading_scale = 1;  // to rad/s and rad
  std::map<std::string, double> standing;    // by recording: what a gyro said standing, taken off [rad/s]
  StreamTiming timing;
  CameraErrors camera;
  GyroErrors gyro;
};

struct SensorsFile {
  std::string name, description;
  std::filesystem::path folder;  // of the file
  std::uint64_t seed = 1;
  std::vector<SyntheticSensor> sensors;
  bool wheels = true;     // whether it says what the filter believes of them
  FusionOptions options;  // filter kind and smoother are the command's business
};

// Throws DataError naming file, path, what was found and what was expected: unknown keys, an unknown type of
// sensor, values that validate() or the generators refuse, values beyond any sensor of a robot
// (docs/fusion.md).
SensorsFile read_sensors(const std::filesystem::path& file);

// Of all sensors and recordings together: 60 bytes each, and half a microsecond (ekf) to two (ukf) to make
// and to filter.
inline constexpr double kMostMeasurements = 2e7;
inline constexpr double kSecondsPerMeasurement = 1e-6;
// How many the rates over the recordings' durations give. Throws DataError when there are more than these.
double require_measurements(const SensorsFile& file, std::span<const Recording> recordings);

// The streams of a recording, those of files without data; same seed, file and recording id: same bits.
std::vector<SensorStream> make_streams(const SensorsFile& file, const Recording& recording,
                                       std::uint64_t seed);

}  // namespace odobench
