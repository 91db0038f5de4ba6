// A number that is to be found, with its box: of a robot, of a problem, of a scenario.
#pragma once

#include <string>

namespace odobench {

// In `unit`. lower == upper means: held fixed.
struct Parameter {
  std::string name;
  std::string unit;
  double nominal = 0;
  double lower = 0;
  double upper = 0;
};

}  // namespace odobench
