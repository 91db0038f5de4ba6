// What controllers of other programs call the numbers of a calibration (docs/export.md has the tables).
#pragma once

#include <string>
#include <vector>

#include "bench/studies/parameter_files.hpp"

namespace odobench {

struct ExportKey {
  std::string path;   // "kinematics.wheels_radius": objects are nested
  std::string value;  // as YAML has it
  std::string remark;
};

struct KeyTable {
  std::string controller;              // its name, and what its node is called unless somebody says otherwise
  std::vector<ExportKey> keys;         // keys of one object one after the other
  std::vector<std::string> losses;     // what the controller cannot say, and the error that this makes
  std::vector<std::string> elsewhere;  // parameters without a key, and where they belong
  std::vector<std::string> statements;  // what a reader should know besides
};

// Of ros2_controllers, for swerve robots of ROS 1. `absolute`: a differential robot's calibrated lengths
// instead of multipliers beside the nominal ones. Throws std::invalid_argument for a robot that none of them
// drives.
KeyTable controller_keys(const ParameterFile& file, bool absolute);

// Every parameter by its own name, and of each wheel x, y, radius, ...: of any robot.
KeyTable generic_keys(const ParameterFile& file);

// Of each wheel x, y, radius and steering_offset below "wheels".
void add_wheel_keys(const ParameterFile& file, KeyTable& table);

}  // namespace odobench
