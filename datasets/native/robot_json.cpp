#include "datasets/native/robot_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "base/names.hpp"
#include "base/text.hpp"
#include "datasets/native/validate.hpp"
#include "datasets/robot_4wis4wid.hpp"
#include "datasets/robots/layouts.hpp"

namespace odobench {
namespace {

using Json = nlohmann::ordered_json;

RobotParameter read_parameter(const JsonNode& p, int schema) {
  RobotParameter parameter{p.at("name").text(), p.text_or_empty("unit"), p.at("nominal").number()};
  if (schema == 1) parameter.unit = p.at("unit").text();
  if (schema == 1 || p.has("lower") || p.has("upper")) {
    parameter.lower = p.at("lower").number();
    parameter.upper = p.at("upper").number();
  }
  return parameter;
}

// "wheels/1/radius" with wheels counted from 0, as in JSON pointers.
Binding read_place(const JsonNode& node, const std::string& text, double factor, std::size_t wheels) {
  const std::size_t first = text.find('/'), second = text.find('/', first + 1);
  const auto fail = [&]() {
    node.fail('"' + shown(text) + '"',
              fmt::format("\"wheels/N/FIELD\" with N below {} and one of x, y, mount, radius, "
                          "roller, zero, offset, trail, gain",
                          wheels));
  };
  if (first == std::string::npos || second == std::string::npos || text.substr(0, first) != "wheels") fail();
  Binding binding;
  const std::string number = text.substr(first + 1, second - first - 1), field = text.substr(second + 1);
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), binding.wheel);
  const auto found = std::find(kWheelFieldNames.begin(), kWheelFieldNames.end(), field);
  if (error != std::errc() || end != number.data() + number.size() || binding.wheel >= wheels ||
      found == kWheelFieldNames.end())
    fail();
  binding.field = static_cast<WheelField>(found - kWheelFieldNames.begin());
  binding.factor = factor;
  return binding;
}

// One place, a list of places, or an object of places with factors.
std::vector<Binding> read_bindings(const JsonNode& node, std::size_t wheels) {
  std::vector<Binding> bindings;
  if (node.is_object())
    for (const std::string& place : node.keys())
      bindings.push_back(read_place(node, place, node.at(place).number(), wheels));
  else if (node.is_array())
    for (const JsonNode& place : node.elements())
      bindings.push_back(read_place(place, place.text(), 1, wheels));
  else
    bindings.push_back(read_place(node, node.text(), 1, wheels));
  return bindings;
}

Wheel read_wheel(const JsonNode& node) {
  node.allow_only({"x", "y", "mount", "radius", "roller", "zero", "offset", "trail", "gain", "drive",
                   "steering", "slides"});
  Wheel wheel;
  for (std::size_t f = 0; f < kWheelFieldNames.size(); ++f) {
    const std::string name(kWheelFieldNames[f]);
    if (node.has(name)) wheel.*kWheelFieldMembers[f] = node.at(name).number();
  }
  if (node.has("drive")) {
    const JsonNode drive = node.at("drive");
    if (drive.is_object()) {
      for (const std::string& name : drive.keys()) wheel.drive.push_back({name, drive.at(name).number()});
    } else if (!drive.text().empty()) {
      wheel.drive = {{drive.text(), 1}};
    }
  }
  wheel.steering = node.text_or_empty("steering");
  if (node.has("slides")) wheel.slides = node.at("slides").boolean();
  return wheel;
}

// What a parameter sets starts at 0: a wheel that states it too would count it twice.
void bind(const JsonNode& robot, const JsonNode& sets, const Binding& binding, WheelTable& table) {
  const std::string field(name_of(binding.field));
  if (robot.at("wheels").elements()[binding.wheel].has(field))
    sets.fail(fmt::format("{} of wheel {}, which the wheel states too", field, binding.wheel),
              "it in one of the two places");
  field_of(table.wheels[binding.wheel], binding.field) = 0;
}

Robot read_own_wheels(const JsonNode& node) {
  Robot robot;
  robot.kinematics = kOwnWheels;
  robot.rule = robots::IntegrationRule::Arc;
  for (const JsonNode& wheel : node.at("wheels").elements()) robot.table.wheels.push_back(read_wheel(wheel));
  for (const JsonNode& p : node.at("parameters").elements()) {
    p.allow_only({"name", "unit", "nominal", "lower", "upper", "sets"});
    BoundParameter bound{read_parameter(p, 2), {}};
    if (bound.parameter.unit.empty()) p.at("unit");
    if (!p.has("lower")) set_default_box(bound.parameter);
    bound.bindings = read_bindings(p.at("sets"), robot.table.wheels.size());
    for (const Binding& b : bound.bindings) bind(node, p.at("sets"), b, robot.table);
    robot.parameters.push_back(bound.parameter);
    robot.table.parameters.push_back(std::move(bound));
  }
  return robot;
}

Robot read_class(const JsonNode& node, const std::string& kinematics) {
  std::vector<RobotParameter> parameters;
  std::map<std::string, double> dimensions;
  std::vector<std::pair<std::string, std::string>> ties;
  if (node.has("dimensions"))
    for (const std::string& name : node.at("dimensions").keys())
      dimensions[name] = node.at("dimensions").at(name).number();
  if (node.has("parameters"))
    for (const JsonNode& p : node.at("parameters").elements()) {
      if (p.has("equals")) {
        p.allow_only({"name", "equals"});
        ties.emplace_back(robots::own_name(kinematics, p.at("name").text()),
                          robots::own_name(kinematics, p.at("equals").text()));
        continue;
      }
      p.allow_only({"name", "unit", "nominal", "lower", "upper"});
      parameters.push_back(read_parameter(p, 2));
      parameters.back().name = robots::own_name(kinematics, parameters.back().name);
      if (p.has("lower")) continue;
      RobotParameter& last = parameters.back();
      // The unit is that of the class where the set leaves it out.
      const Robot whole = robot_of_class(kinematics, {}, dimensions);
      for (const RobotParameter& own : whole.parameters)
        if (own.name == last.name && last.unit.empty()) last.unit = own.unit;
      set_default_box(last);
    }
  return robot_of_class(kinematics, parameters, dimensions, ties);
}

void read_rules(const JsonNode& node, Robot& robot) {
  if (node.has("twist")) {
    robot.table.rule = twist_rule(node.at("twist").text());
  }
  if (node.has("integration")) robot.rule = robots::integration_rule(node.at("integration").text());
  if (node.has("model"))
    for (const JsonNode& name : node.at("model").elements()) robot.model.push_back(name.text());
}

}  // namespace

Robot read_robot(const JsonNode& node, int schema) {
  if (schema == 1) {
    node.allow_only({"name", "kinematics", "parameters"});
    Robot robot;
    robot.name = node.at("name").text();
    robot.kinematics = node.at("kinematics").text();
    for (const JsonNode& p : node.at("parameters").elements()) {
      p.allow_only({"name", "unit", "nominal", "lower", "upper"});
      robot.parameters.push_back(read_parameter(p, schema));
    }
    validate_robot(robot, node.file());
    const std::string name = robot.name;
    robot = robot_of_class(robot.kinematics, robot.parameters);
    robot.name = name;
    return robot;
  }
  const std::string kinematics = node.at("kinematics").text();
  node.allow_only(
      {"name", "kinematics", "parameters", "dimensions", "wheels", "twist", "integration", "model"});
  if (kinematics != kOwnWheels && node.has("wheels"))
    node.fail("\"wheels\" beside a class", "them with \"kinematics\": \"wheels\" only");
  if (kinematics == kOwnWheels && node.has("dimensions"))
    node.fail("\"dimensions\" beside wheels", "them with a class only");
  Robot robot;
  try {
    robot = kinematics == kOwnWheels ? read_own_wheels(node) : read_class(node, kinematics);
    read_rules(node, robot);
  } catch (const std::invalid_argument& error) {  // of the class, which knows no file
    throw DataError(fmt::format("{}: {}: {}", node.file(), node.path(), error.what()));
  }
  robot.name = node.at("name").text();
  validate_robot(robot, node.file());
  return robot;
}

bool fits_schema_1(const Robot& robot) {
  return robot.kinematics == "4wis4wid" && robot.ties.empty() && robot.dimensions.empty() &&
         robot.parameters.size() == 3 * kWheelCount && robot.table.rule == TwistRule::Mean &&
         robot.rule == robots::IntegrationRule::Euler && robot.model.empty();
}

namespace {

Json wheel_json(const Wheel& wheel, const std::vector<bool>& bound) {
  Json json = Json::object();
  for (std::size_t f = 0; f < kWheelFieldNames.size(); ++f)
    if (!bound[f]) json[std::string(kWheelFieldNames[f])] = wheel.*kWheelFieldMembers[f];
  Json drive = Json::object();
  for (const DriveSignal& signal : wheel.drive) drive[signal.name] = signal.weight;
  json["drive"] = std::move(drive);
  json["steering"] = wheel.steering;
  json["slides"] = wheel.slides;
  return json;
}

Json wheels_json(const WheelTable& table) {
  Json wheels = Json::array();
  for (std::size_t i = 0; i < table.wheels.size(); ++i) {
    std::vector<bool> bound(kWheelFieldNames.size());
    for (const BoundParameter& p : table.parameters)
      for (const Binding& b : p.bindings)
        if (b.wheel == i) bound[static_cast<std::size_t>(b.field)] = true;
    wheels.push_back(wheel_json(table.wheels[i], bound));
  }
  return wheels;
}

Json bindings_json(const std::vector<Binding>& bindings) {
  Json sets = Json::object();
  for (const Binding& b : bindings) sets[fmt::format("wheels/{}/{}", b.wheel, name_of(b.field))] = b.factor;
  return sets;
}

}  // namespace

Json robot_json(const Robot& robot, int schema) {
  const bool own = robot.kinematics == kOwnWheels;
  Json parameters = Json::array();
  for (std::size_t i = 0; i < robot.parameters.size(); ++i) {
    const RobotParameter& p = robot.parameters[i];
    parameters.push_back(
        {{"name", p.name}, {"unit", p.unit}, {"nominal", p.nominal}, {"lower", p.lower}, {"upper", p.upper}});
    if (own) parameters.back()["sets"] = bindings_json(robot.table.parameters.at(i).bindings);
  }
  for (const auto& [name, other] : robot.ties) parameters.push_back({{"name", name}, {"equals", other}});
  Json json = {{"name", robot.name}, {"kinematics", robot.kinematics}};
  if (schema > 1) {
    json["twist"] = kTwistRuleNames[static_cast<std::size_t>(robot.table.rule)];
    json["integration"] = robots::name_of(robot.rule);
    if (!robot.model.empty()) json["model"] = robot.model;
    if (!robot.dimensions.empty()) json["dimensions"] = robot.dimensions;
    if (own) json["wheels"] = wheels_json(robot.table);
  }
  json["parameters"] = std::move(parameters);
  return json;
}

}  // namespace odobench
