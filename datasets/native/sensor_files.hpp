// Gyro and camera of a set as files beside it, and a sensors file of `bench fuse` that names them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/files.hpp"
#include "datasets/sensor_rows.hpp"

namespace odobench {

// Adds STEM_recordings/NAME_ID.csv (time_us and the columns) of every recording, and STEM_sensors.json with
// the sensors that all recordings have: a gyro with the deviation that it had standing (0.01 rad/s, where it
// never stood) and what to take off it, a camera believed to 2 cm and 0.02 rad with its usual delay. Nothing
// without sensors. `ids`: of the set's recordings. Returns remarks: what was written, what is not listed.
std::vector<std::string> add_sensor_files(const SetSensors& sensors, const std::vector<std::string>& ids,
                                          const std::filesystem::path& set_json, FileTransaction& files);

// STEM_sensors.json beside the set.
std::filesystem::path sensors_file_of(const std::filesystem::path& set_json);

}  // namespace odobench
