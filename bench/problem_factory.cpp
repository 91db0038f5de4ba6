#include "bench/problem_factory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "bench/locations.hpp"
#include "datasets/error.hpp"
#include "datasets/sha256.hpp"
#include "problems/classic/classic_problems.hpp"
#include "solvers/options.hpp"

namespace odobench {

std::vector<ParameterInfo> robot_parameters(const Robot& robot) {
  std::vector<ParameterInfo> list;
  for (const RobotParameter& p : robot.parameters)
    list.push_back({p.name, p.unit, p.nominal, p.lower, p.upper});
  return list;
}

int usual_dimension(const std::string& classic) {
  const ClassicEntry* entry = find_classic_problem(classic);
  if (entry == nullptr) throw std::invalid_argument(fmt::format("unknown problem '{}'", classic));
  return entry->dimension;
}

std::vector<std::string> problem_names() {
  std::vector<std::string> names = {"calibration"};
  for (const std::string& name : classic_problem_names()) names.push_back(name);
  return names;
}

LoadedProblem load_calibration(const std::string& data, InstructionSet kernel) {
  const std::filesystem::path path = data.empty() ? demo_set() : std::filesystem::path(data);
  Dataset dataset = load_dataset(path);
  if (dataset.robot.kinematics != "4wis4wid")
    throw DataError(fmt::format("{}: robot.kinematics is '{}'; the calibration problem knows 4wis4wid",
                                path.string(), dataset.robot.kinematics));
  std::shared_ptr<const CalibrationProblem> model;
  try {
    model = std::make_shared<const CalibrationProblem>(robot_parameters(dataset.robot),
                                                       std::move(dataset.recordings), kernel);
  } catch (const std::invalid_argument& error) {  // what is wrong with the set is no usage error
    throw DataError(fmt::format("{}: {}", path.string(), error.what()));
  }
  dataset.recordings.clear();
  return {Problem(model), model, std::move(dataset), path.string(), sha256_of_file(path)};
}

LoadedProblem make_problem(const std::string& name, int dimension, const std::string& data,
                           InstructionSet kernel) {
  if (name == "calibration") {
    if (dimension != 0)
      throw std::invalid_argument("--dimension: the calibration problem has the dimension of its robot");
    return load_calibration(data, kernel);
  }
  const std::vector<std::string> names = problem_names();
  if (std::find(names.begin(), names.end(), name) == names.end()) {
    const std::string near = nearest_name(name, names);
    throw std::invalid_argument(fmt::format("unknown problem '{}'{}; 'bench list problems' shows all", name,
                                            near.empty() ? "" : fmt::format(", did you mean '{}'?", near)));
  }
  if (!data.empty())
    throw std::invalid_argument(fmt::format("--data: the problem '{}' takes no data set", name));
  return {make_classic_problem(name, dimension), nullptr, std::nullopt, "", ""};
}

}  // namespace odobench
