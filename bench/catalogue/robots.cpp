#include "bench/catalogue/robots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "base/names.hpp"
#include "base/text.hpp"
#include "datasets/native/dataset_format.hpp"
#include "datasets/native/robot_json.hpp"
#include "datasets/robots/layouts.hpp"
#include "problems/robots/wheeled_robot.hpp"
#include "problems/simulation/scenario_file.hpp"

namespace odobench {
namespace fs = std::filesystem;
namespace {

constexpr int kRobotSchema = 2;  // of data sets, whose "robot" a robot alone is

bool is_file(const std::string& source) {
  std::error_code error;
  return fs::exists(source, error) && !fs::is_directory(source, error);
}
bool is_class(const std::string& name) {
  const auto& all = robots::layouts();
  return std::any_of(all.begin(), all.end(), [&](const robots::Layout& l) { return l.name == name; });
}
bool is_set(const JsonNode& root) {
  return root.has("schema") && root.text_or_empty("schema") == kDatasetSchema;
}
bool is_robot_alone(const JsonNode& root) {
  return !root.has("schema") && root.has("kinematics");
}

KnownRobot from_file(const std::string& source) {
  const JsonNode root = JsonNode::read(source);
  KnownRobot known;
  known.source = source;
  if (is_set(root)) {
    known.dataset = load_dataset(source);
    known.robot = known.dataset->robot;
    known.name = known.dataset->name;
  } else if (is_robot_alone(root)) {
    known.robot = read_robot(root, kRobotSchema);
    known.name = known.robot.name;
  } else if (root.has("schema") && root.at("schema").text() == simulate::kScenarioSchema) {
    root.at("schema").fail(
        fmt::format("\"{}\"", simulate::kScenarioSchema),
        fmt::format("\"{}\" or a robot alone; a scenario is given as --scenario", kDatasetSchema));
  } else if (root.has("schema")) {
    root.at("schema").fail(fmt::format("\"{}\" or a robot alone, which has \"kinematics\"", kDatasetSchema));
  } else {
    root.fail("neither \"schema\" nor \"kinematics\"", "a set.json, or what it has as \"robot\"");
  }
  return known;
}

}  // namespace

std::string robot_class(const std::string& typed) {
  return typed == "diff" ? "differential" : typed;
}

bool is_robot(const std::string& source) {
  if (!is_file(source)) return is_class(robot_class(source));
  const JsonNode root = JsonNode::read(source);
  return root.is_object() && (is_set(root) || is_robot_alone(root));
}

KnownRobot load_robot(const std::string& source) {
  if (!is_file(source)) {
    const std::string name = robot_class(source);
    std::vector<std::string> names;
    for (const robots::Layout& layout : robots::layouts()) names.push_back(layout.name);
    if (!is_class(name))
      throw std::invalid_argument(
          fmt::format("--robot={}: neither a file nor a class of robots{}; 'bench list robots' shows them",
                      shown(source), did_you_mean(source, names)));
    return {source, name, robot_of_class(name, {}), std::nullopt};
  }
  KnownRobot known = from_file(source);
  try {
    const robots::WheeledRobot model(known.robot.table);
  } catch (const std::invalid_argument& error) {  // what is wrong with a file is no usage error
    throw DataError(fmt::format("{}: {}", source, error.what()));
  }
  return known;
}

}  // namespace odobench
