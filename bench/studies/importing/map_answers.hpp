// What a proposed map leaves open, filled in by who knows the robot.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace odobench {

struct MapAnswers {
  std::string robot;  // a class of robots; "": as proposed
  std::map<std::string, double>
      nominal;                     // parameters in m, rad or ratios; "r" stands for r_left, r_right, r1, ...
  std::optional<double> per_turn;  // counts of a turn of a wheel
  std::string name;                // of the set; "": as proposed
};

// "b=0.4,r=0.05". Throws std::invalid_argument naming the option.
std::map<std::string, double> parse_nominal(const std::string& option, const std::string& text);

// The map with answers in the place of null. Throws std::invalid_argument, one line, that lists what is still
// open and the options that would say it; and for nominal values of parameters that the robot has not.
std::string fill_map(const std::string& proposed, const MapAnswers& answers);

}  // namespace odobench
