#include "bench/catalogue/scenarios.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "base/angle.hpp"
#include "base/names.hpp"
#include "bench/catalogue/locations.hpp"
#include "problems/simulation/scenario_file.hpp"
#include "solvers/options.hpp"

namespace odobench {
namespace fs = std::filesystem;
namespace {

// A number, or {"value", "unit", "origin", "text"} with the right unit and an honest origin.
double robot_value(const JsonNode& node, const dynamics::ParameterDescription& description) {
  bool object = true;
  try {
    (void)node.keys();
  } catch (const DataError&) {
    object = false;
  }
  if (!object) return node.number();
  node.allow_only({"value", "unit", "origin", "text"});
  if (node.has("unit") && node.at("unit").text() != description.unit)
    node.at("unit").fail(fmt::format("\"{}\"", node.at("unit").text()),
                         fmt::format("\"{}\"", description.unit));
  if (node.has("origin")) {
    const std::string origin = node.at("origin").text();
    if (origin != "given" && origin != "chosen")
      node.at("origin").fail(fmt::format("\"{}\"", origin), "given or chosen");
  }
  return node.at("value").number();
}

dynamics::RobotParameters read_robot(const JsonNode& node) {
  dynamics::RobotParameters robot = dynamics::robot_set("grip");
  if (node.has("set")) {
    const std::vector<std::string> sets = dynamics::robot_set_names();
    const std::string name = node.at("set").text();
    if (std::find(sets.begin(), sets.end(), name) == sets.end())
      node.at("set").fail(fmt::format("\"{}\"", name), "grip or hint");
    robot = dynamics::robot_set(name);
  }
  std::string names;
  for (const auto& d : dynamics::parameter_descriptions()) names += std::string(", ") + d.name;
  for (const std::string& key : node.keys()) {
    if (key == "set") continue;
    const auto same = [&key](const dynamics::ParameterDescription& d) { return d.name == key; };
    const auto& all = dynamics::parameter_descriptions();
    const auto found = std::find_if(all.begin(), all.end(), same);
    if (found == all.end()) node.fail(fmt::format("unknown key \"{}\"", key), "one of set" + names);
    found->value(robot) = robot_value(node.at(key), *found);
  }
  return robot;
}

dynamics::ModelOptions read_model(const JsonNode& node) {
  node.allow_only({"torque_with_radius", "wheel_contact", "load_torque"});
  dynamics::ModelOptions model;
  if (node.has("torque_with_radius")) model.torque_with_radius = node.at("torque_with_radius").boolean();
  if (node.has("wheel_contact")) model.wheel_contact = node.at("wheel_contact").boolean();
  if (node.has("load_torque")) model.load_torque = node.at("load_torque").boolean();
  return model;
}

dynamics::IntegrationOptions read_integration(const JsonNode& node) {
  node.allow_only({"method", "step_s", "relative_tolerance", "absolute_tolerance"});
  dynamics::IntegrationOptions options;
  if (node.has("method")) {
    const std::string method = node.at("method").text();
    if (method != "rk4" && method != "dopri5")
      node.at("method").fail(fmt::format("\"{}\"", method), "rk4 or dopri5");
    options.method = method == "rk4" ? dynamics::Method::RungeKutta4 : dynamics::Method::DormandPrince;
    for (const char* key : {"relative_tolerance", "absolute_tolerance"})
      if (method == "rk4" && node.has(key))
        node.at(key).fail("contradictory options: rk4 has fixed steps and no tolerance", "method dopri5");
  }
  if (node.has("step_s")) options.step_s = node.at("step_s").number();
  if (node.has("relative_tolerance")) options.relative_tolerance = node.at("relative_tolerance").number();
  if (node.has("absolute_tolerance")) options.absolute_tolerance = node.at("absolute_tolerance").number();
  return options;
}

dynamics::PerWheel per_wheel(const JsonNode& node, double unit) {
  const std::vector<double> values = node.numbers();
  if (values.size() != dynamics::kWheels)
    node.fail(fmt::format("{} numbers", values.size()), "four, one per wheel");
  dynamics::PerWheel wheels{};
  for (std::size_t i = 0; i < dynamics::kWheels; ++i) wheels[i] = values[i] * unit;
  return wheels;
}

std::vector<dynamics::Segment> read_segments(const JsonNode& node) {
  std::vector<dynamics::Segment> segments;
  for (const JsonNode& item : node.elements()) {
    item.allow_only({"until_s", "voltage_V", "steering_deg", "ramp"});
    dynamics::Segment segment;
    segment.until_s = item.at("until_s").number();
    segment.voltage = per_wheel(item.at("voltage_V"), 1);
    if (item.has("steering_deg")) segment.steering = per_wheel(item.at("steering_deg"), kDegree);
    if (item.has("ramp")) segment.ramp = item.at("ramp").boolean();
    segments.push_back(segment);
  }
  return segments;
}

DynamicsScenario read_dynamics(const JsonNode& root, const simulate::ScenarioHead& head) {
  root.allow_only({"schema", "schema_version", "kind", "name", "description", "robot", "model", "integration",
                   "segments", "output_step_s", "noise", "acceleration_frame"});
  DynamicsScenario s;
  s.name = head.name;
  s.description = head.description;
  s.setup.robot = root.has("robot") ? read_robot(root.at("robot")) : dynamics::robot_set("grip");
  if (root.has("model")) s.setup.model = read_model(root.at("model"));
  if (root.has("integration")) s.setup.integration = read_integration(root.at("integration"));
  s.setup.segments = read_segments(root.at("segments"));
  if (root.has("output_step_s")) s.output_step_s = root.at("output_step_s").number();
  if (root.has("noise")) {
    const JsonNode noise = root.at("noise");
    noise.allow_only({"encoder_m2", "acceleration_m2_s4", "yaw_deg2"});
    if (noise.has("encoder_m2")) s.noise.encoder_m2 = noise.at("encoder_m2").number();
    if (noise.has("acceleration_m2_s4")) s.noise.acceleration_m2_s4 = noise.at("acceleration_m2_s4").number();
    if (noise.has("yaw_deg2")) s.noise.yaw_deg2 = noise.at("yaw_deg2").number();
  }
  if (root.has("acceleration_frame")) {
    const std::string frame = root.at("acceleration_frame").text();
    if (frame != "body" && frame != "world")
      root.at("acceleration_frame").fail(fmt::format("\"{}\"", frame), "body or world");
    s.frame = frame == "body" ? dynamics::AccelerationFrame::Body : dynamics::AccelerationFrame::World;
  }
  try {
    s.setup.validate();
    s.noise.validate();
    dynamics::check_size(s.setup, s.output_step_s);
  } catch (const std::invalid_argument& error) {  // what is wrong with a file is no usage error
    throw DataError(fmt::format("{}: {}", root.file(), error.what()));
  }
  return s;
}

fs::path find(const std::string& source) {
  std::error_code error;
  if (fs::exists(source, error) && !fs::is_directory(source, error)) return source;
  std::vector<std::string> names;
  std::string list;
  for (const auto& [name, path] : known_scenarios()) {
    if (name == source) return path;
    names.push_back(name);
    list += (list.empty() ? "" : ", ") + name;
  }
  throw std::invalid_argument(fmt::format("--scenario={}: neither a file nor a known scenario{}; known: {}",
                                          source, did_you_mean(source, names), list));
}

}  // namespace

std::vector<std::pair<std::string, fs::path>> known_scenarios() {
  std::vector<std::pair<std::string, fs::path>> list;
  const fs::path folder = scenario_folder();
  if (folder.empty()) return list;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".json" && entry.path().stem() != "schema")
      list.emplace_back(entry.path().stem().string(), entry.path());
  std::sort(list.begin(), list.end());
  return list;
}

Scenario load_scenario(const std::string& source) {
  const JsonNode root = JsonNode::read(find(source));
  const simulate::ScenarioHead head = simulate::read_head(root);
  if (head.kind == "dynamics") return read_dynamics(root, head);
  return simulate::read_scenario(root);
}

simulate::RecordingScenario load_recording_scenario(const std::string& source) {
  Scenario scenario = load_scenario(source);
  if (auto* recordings = std::get_if<simulate::RecordingScenario>(&scenario)) return std::move(*recordings);
  throw std::invalid_argument(
      fmt::format("--scenario={}: its kind is dynamics, expected one of kind recordings", source));
}

std::string robot_json(const dynamics::RobotParameters& robot) {
  dynamics::RobotParameters copy = robot;
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const dynamics::ParameterDescription& d : dynamics::parameter_descriptions()) {
    json[d.name] = {{"value", d.value(copy)}, {"unit", d.unit}, {"origin", d.given ? "given" : "chosen"}};
    if (*d.text != '\0') json[d.name]["text"] = d.text;
  }
  return json.dump(2) + "\n";
}

}  // namespace odobench
