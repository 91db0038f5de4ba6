#include "bench/studies/importing/map_answers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "base/names.hpp"
#include "base/text.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/catalogue/robots.hpp"
#include "datasets/robots/layouts.hpp"

namespace odobench {
namespace {

using MapJson = nlohmann::ordered_json;

// "r" of r_left and of r1: one value for all wheels.
std::string kind_of(const std::string& parameter) {
  return parameter.substr(0, parameter.find_first_of("_0123456789"));
}

MapJson parameters_of(const std::string& kinematics) {
  MapJson parameters = MapJson::array();
  for (const BoundParameter& p : robots::make_robot(robots::layout(kinematics)).parameters)
    parameters.push_back(
        {{"name", p.parameter.name},
         {"nominal", p.parameter.unit == "m" ? MapJson(nullptr) : MapJson(p.parameter.nominal)}});
  return parameters;
}

void refuse_unused(const std::set<std::string>& used, const std::map<std::string, double>& nominal,
                   const MapJson& parameters) {
  std::vector<std::string> known;
  for (const MapJson& p : parameters) known.push_back(p.at("name").get<std::string>());
  for (const auto& [name, value] : nominal)
    if (!used.contains(name))
      throw std::invalid_argument(fmt::format("--nominal: found '{}'{}, expected parameters of the robot: {}",
                                              shown(name), did_you_mean(name, known),
                                              fmt::join(known, ", ")));
}

}  // namespace

std::map<std::string, double> parse_nominal(const std::string& option, const std::string& text) {
  std::map<std::string, double> values;
  for (const std::string& item : comma_items(text)) {
    const std::size_t equals = item.find('=');
    double value = 0;
    const char* const begin = item.data() + (equals == std::string::npos ? item.size() : equals + 1);
    const char* const end = item.data() + item.size();
    const auto [stop, error] = std::from_chars(begin, end, value);
    if (equals == 0 || begin == end || stop != end || error != std::errc() || !std::isfinite(value))
      throw std::invalid_argument(
          fmt::format("{}: found '{}', expected NAME=VALUE,... such as b=0.4,r=0.05", option, shown(item)));
    values[item.substr(0, equals)] = value;
  }
  return values;
}

std::string fill_map(const std::string& proposed, const MapAnswers& answers) {
  MapJson map = MapJson::parse(proposed);
  MapJson& robot = map["robot"];
  if (!answers.name.empty()) map["name"] = robot["name"] = answers.name;
  if (!answers.robot.empty() && robot["kinematics"] != robot_class(answers.robot)) {
    robot["kinematics"] = robot_class(answers.robot);
    robot["parameters"] = parameters_of(robot_class(answers.robot));
  }
  std::vector<std::string> open;
  if (robot["kinematics"].is_null()) open.emplace_back("--robot=CLASS (bench list robots)");
  std::map<std::string, double> nominal;
  for (const auto& [name, value] : answers.nominal)
    nominal[robot["kinematics"].is_null() ? name
                                          : robots::own_name(robot["kinematics"].get<std::string>(), name)] =
        value;
  std::set<std::string> used;
  std::vector<std::string> lengths;
  for (MapJson& p : robot["parameters"]) {
    const std::string name = p.at("name").get<std::string>();
    for (const std::string& key : {kind_of(name), name})  // the single one goes before its kind
      if (const auto found = nominal.find(key); found != nominal.end()) {
        p["nominal"] = found->second;
        used.insert(key);
      }
    if (p["nominal"].is_null()) lengths.push_back(name);
  }
  refuse_unused(used, nominal, robot["parameters"]);
  if (!lengths.empty())
    open.push_back(fmt::format("--nominal={}=... (nominal sizes in m, as the controller has them)",
                               fmt::join(lengths, "=...,")));
  bool counts = false;
  for (auto& [name, signal] : map["signals"].items()) {
    if (signal.contains("per_turn") && signal["per_turn"].is_null()) {
      if (answers.per_turn)
        signal["per_turn"] = *answers.per_turn;
      else
        counts = true;
    }
    if (signal.contains("radius") && signal["radius"].is_null())
      open.push_back(fmt::format("the radius (m) that {} was computed with, in a map (--map)", shown(name)));
    if (signal.contains("unit") && signal["unit"].is_null())
      open.push_back(fmt::format("the unit of {}, in a map (--map)", shown(name)));
  }
  if (counts) open.emplace_back("--per-turn=N (counts of a turn of the wheel, gear included)");
  if (!open.empty())
    throw std::invalid_argument(
        fmt::format("the log does not say everything: add {}", fmt::join(open, "; ")));
  return map.dump(2) + "\n";
}

}  // namespace odobench
