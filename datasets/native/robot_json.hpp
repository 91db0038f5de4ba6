// The robot of a set.json: schema 1 knows the thesis' robot, schema 2 every class and a user's own wheels.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "base/json_node.hpp"
#include "datasets/robots/robot.hpp"

namespace odobench {

// Throws DataError "file: /robot/...: found ..., expected ...".
Robot read_robot(const JsonNode& node, int schema);

// Whether the robot fits into schema 1: the class 4wis4wid with its twelve parameters and rules.
bool fits_schema_1(const Robot& robot);
nlohmann::ordered_json robot_json(const Robot& robot, int schema);

}  // namespace odobench
