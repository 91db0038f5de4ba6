// A calibration as text for other programs: lines to paste, never the rewriting of somebody's files.
#pragma once

#include <string>

#include "bench/studies/exporting/controller_keys.hpp"

namespace odobench {

// The document, "NODE:\n  ros__parameters:\n    ..." behind comments of where it comes from.
std::string yaml_text(const ParameterFile& file, const KeyTable& table, const std::string& node);

// Properties of xacro, and of each wheel the origin of its joint and its cylinder.
std::string urdf_text(const ParameterFile& file);

// #define PREFIX_NAME value of every parameter and of every wheel.
std::string c_text(const ParameterFile& file, const std::string& prefix);

// Java for WPILib, modules in its order: front left, front right, back left, back right. Throws
// std::invalid_argument for robots that it has no kinematics for.
std::string wpilib_text(const ParameterFile& file);

}  // namespace odobench
