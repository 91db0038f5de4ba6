// Robots by class or file, for verbs that need no recordings: `--robot=FILE|CLASS`.
#pragma once

#include <optional>
#include <string>

#include "datasets/dataset.hpp"

namespace odobench {

struct KnownRobot {
  std::string source;  // as typed
  std::string name;    // of the data set, of the robot of a file without one, or the class
  Robot robot;
  std::optional<Dataset> dataset;  // of a set.json
};

// "diff" is short for "differential".
std::string robot_class(const std::string& typed);

// Whether this is a class, or a file that holds a data set or a robot alone; not, for example, a scenario.
// Throws DataError where the file is no JSON.
bool is_robot(const std::string& source);

// A set.json, a JSON file that is what a set.json of schema 2 has as "robot", or a class with its usual
// dimensions. Throws std::invalid_argument on a name that is neither file nor class, DataError on a file that
// is something else or whose wheels are no robot, on a scenario with how to give it.
KnownRobot load_robot(const std::string& source);

}  // namespace odobench
