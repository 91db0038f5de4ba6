// Parameters of stored runs to robots: the study behind `bench export DIR --to=TARGET`.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace odobench {

struct RobotExport {
  std::filesystem::path run;  // run directory
  std::string target;         // ros2, urdf, yaml, json, c, wpilib
  std::string row;            // label; "": the one with the lowest J
  std::string node;           // "": that of the controller
  bool absolute = false;      // of a differential robot
};

struct ExportedRobot {
  std::string text;
  std::string row;                    // whose parameters they are
  std::vector<std::string> warnings;  // what is lost, values on their bounds
};

// Throws std::invalid_argument on an unknown target or row (with the nearest), a name that no node can have,
// options that the target does not know and a robot that it does not know; DataError where no calibrated
// parameters are stored and on bad files.
ExportedRobot export_robot(const RobotExport& study);

}  // namespace odobench
