// Classes of wheeled robots as tables of wheels, with nominal dimensions, default bounds and what no data can
// tell.
//
// A new class is a function in layouts.cpp and a row in its table; docs/robots.md describes all of them.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/robots/integration_rule.hpp"
#include "datasets/robots/wheel.hpp"

namespace odobench::robots {

// Nominal values by name: dimensions of the class ("R": of all wheels) and single parameters ("R2"), which go
// before them.
using Dimensions = std::map<std::string, double>;

// What a layout asks for, with the value that is used when nothing is given.
struct Dimension {
  std::string name;
  double value = 0;
};

class DimensionReader;  // layouts.cpp

struct Layout {
  std::string name;         // "differential"
  std::string description;  // one line
  IntegrationRule rule = IntegrationRule::Arc;
  std::vector<std::string> blind;  // combinations of parameters that no data can tell, or only some, in words
  std::function<WheelTable(DimensionReader&)> make;
};

// In the order of the documentation.
const std::vector<Layout>& layouts();
// "diff" is short for "differential". Throws std::invalid_argument for an unknown name, with the nearest one.
const Layout& layout(std::string_view name);
// A class' own name of a parameter that controllers call otherwise: "b" for "wheel_separation" of two driven
// wheels, "r" for "wheel_radius" of a tricycle. Other names come back as they are.
std::string own_name(std::string_view kinematics, std::string_view parameter);

// The dimensions that a layout knows, with their defaults (for the default number of modules).
std::vector<Dimension> dimensions(const Layout& layout);

// The robot with these dimensions, others as by default. Throws std::invalid_argument for a dimension that
// the layout does not know, with the nearest one, for one that is not finite, and for a length <= 0.
WheelTable make_robot(const Layout& layout, const Dimensions& given = {});

}  // namespace odobench::robots
