#include "datasets/robots/robot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "base/names.hpp"
#include "base/text.hpp"
#include "datasets/robots/layouts.hpp"

namespace odobench {
namespace {

BoundParameter& parameter_called(const std::string& name, const std::string& kinematics, WheelTable& table) {
  std::vector<std::string> known;
  for (BoundParameter& p : table.parameters) {
    if (p.parameter.name == name) return p;
    known.push_back(p.parameter.name);
  }
  throw std::invalid_argument(
      fmt::format("{} has no parameter '{}'{}", kinematics, name, did_you_mean(name, known)));
}

// Modules of a swerve robot are as many as there are x1, x2, ...
void count_modules(const std::vector<RobotParameter>& parameters, robots::Dimensions& given) {
  const auto has = [&](const std::string& name) {
    return std::any_of(parameters.begin(), parameters.end(), [&](const auto& p) { return p.name == name; });
  };
  int count = 0;
  while (has(fmt::format("x{}", count + 1))) ++count;
  if (count > 0 && !given.contains("modules")) given["modules"] = count;
}

void tie(const std::pair<std::string, std::string>& names, const std::string& kinematics, WheelTable& table) {
  const BoundParameter tied = parameter_called(names.first, kinematics, table);
  BoundParameter& other = parameter_called(names.second, kinematics, table);
  if (names.first == names.second || tied.parameter.unit != other.parameter.unit)
    throw std::invalid_argument(fmt::format("parameter '{}' ({}) cannot equal '{}' ({})", names.first,
                                            tied.parameter.unit, names.second, other.parameter.unit));
  other.bindings.insert(other.bindings.end(), tied.bindings.begin(), tied.bindings.end());
  std::erase_if(table.parameters, [&](const BoundParameter& p) { return p.parameter.name == names.first; });
}

}  // namespace

TwistRule twist_rule(std::string_view name) {
  if (name == "mean") return TwistRule::Mean;
  if (name == "least_squares" || name == "least-squares") return TwistRule::LeastSquares;
  throw std::invalid_argument(
      fmt::format("unknown twist rule '{}'; expected least_squares or mean", shown(name)));
}

std::vector<Wheel> wheels_with(const WheelTable& table, const std::vector<double>& values) {
  std::vector<Wheel> wheels = table.wheels;
  for (std::size_t i = 0; i < table.parameters.size(); ++i)
    for (const Binding& binding : table.parameters[i].bindings)
      field_of(wheels.at(binding.wheel), binding.field) += binding.factor * values.at(i);
  return wheels;
}

void set_default_box(RobotParameter& p) {
  const double box =
      p.unit == "m" ? 0.15 * std::abs(p.nominal) : 0.1 * (p.unit == "ratio" ? std::abs(p.nominal) : 1);
  p.lower = p.nominal - box;
  p.upper = p.nominal + box;
}

Robot robot_of_class(const std::string& kinematics, const std::vector<RobotParameter>& parameters,
                     const std::map<std::string, double>& dimensions,
                     const std::vector<std::pair<std::string, std::string>>& ties) {
  const robots::Layout& layout = robots::layout(kinematics);
  robots::Dimensions given = dimensions;
  if (kinematics.rfind("swerve", 0) == 0) count_modules(parameters, given);
  Robot robot;
  robot.name = robot.kinematics = layout.name;
  robot.rule = layout.rule;
  robot.table = robots::make_robot(layout, given);
  robot.dimensions = dimensions;
  robot.ties = ties;
  for (const RobotParameter& p : parameters) {
    RobotParameter& own = parameter_called(p.name, kinematics, robot.table).parameter;
    if (!p.unit.empty() && p.unit != own.unit)
      throw std::invalid_argument(
          fmt::format("parameter '{}' is in {}, expected {}", p.name, p.unit, own.unit));
    own = {p.name, own.unit, p.nominal, p.lower, p.upper};
  }
  for (const auto& names : ties) tie(names, kinematics, robot.table);
  for (const BoundParameter& p : robot.table.parameters) robot.parameters.push_back(p.parameter);
  return robot;
}

}  // namespace odobench
