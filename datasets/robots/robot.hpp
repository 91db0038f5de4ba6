// The robot of a data set: a class of robots with its numbers, or a table of wheels of the user's own.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "datasets/robots/integration_rule.hpp"
#include "datasets/robots/wheel.hpp"

namespace odobench {

inline constexpr const char* kOwnWheels = "wheels";  // as Robot::kinematics

struct Robot {
  std::string name;
  std::string kinematics;                  // a class of datasets/robots/layouts.hpp, or kOwnWheels
  std::vector<RobotParameter> parameters;  // free and fixed ones, those of the table, in its order
  WheelTable table;
  robots::IntegrationRule rule = robots::IntegrationRule::Euler;
  // What the class has beside parameters, where it is not as by default: {"b", 0.5} of a skid-steered robot.
  std::map<std::string, double> dimensions;
  // Names of richer models that calibrations of this robot use (docs/models.md), as the set states them.
  std::vector<std::string> model;
  // Parameters that are another one: {"r_left", "r_right"}. They are not among the parameters.
  std::vector<std::pair<std::string, std::string>> ties;
};

// The robot of this class with these numbers: what `parameters` name is as they say, other parameters are as
// the class has them with these dimensions. Throws std::invalid_argument, naming it, on an unknown class,
// parameter, dimension, on a tie of parameters with different units, and on what robots::make_robot()
// refuses.
Robot robot_of_class(const std::string& kinematics, const std::vector<RobotParameter>& parameters,
                     const std::map<std::string, double>& dimensions = {},
                     const std::vector<std::pair<std::string, std::string>>& ties = {});

// The wheels with these values of the table's parameters, in its order.
std::vector<Wheel> wheels_with(const WheelTable& table, const std::vector<double>& values);

// The box by default: 15 % of a length, 0.1 rad of an angle, 10 % of a ratio to either side.
void set_default_box(RobotParameter& parameter);

}  // namespace odobench
