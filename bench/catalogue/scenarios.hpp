// Scenarios by name or file, of either kind: drives of the robot with four steered wheels
// (problems/simulation), and drives of the four-wheel robot with motors (problems/simulation/motors).
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "problems/simulation/motors/drive.hpp"
#include "problems/simulation/motors/sensors.hpp"
#include "problems/simulation/scenario.hpp"

namespace odobench {

struct DynamicsScenario {
  std::string name, description;
  dynamics::DriveSetup setup;
  double output_step_s = 0.1;
  dynamics::SensorNoise noise;
  dynamics::AccelerationFrame frame = dynamics::AccelerationFrame::Body;
};

using Scenario = std::variant<simulate::RecordingScenario, DynamicsScenario>;

// Scenarios that come with the program: (name, file), sorted.
std::vector<std::pair<std::string, std::filesystem::path>> known_scenarios();

// `source`: a file, or the name of a known scenario. Throws std::invalid_argument on a name that is neither
// (suggests the nearest), DataError "file: /path: ..." on a file with unknown keys or impossible values.
Scenario load_scenario(const std::string& source);
// The same where only one kind makes sense: for drives to calibrate from.
simulate::RecordingScenario load_recording_scenario(const std::string& source);

// The robot of a dynamics scenario with the unit and origin (given, chosen) of every parameter, as such a
// scenario may state it under "robot".
std::string robot_json(const dynamics::RobotParameters& robot);

}  // namespace odobench
