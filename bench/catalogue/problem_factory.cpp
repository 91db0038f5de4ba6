#include "bench/catalogue/problem_factory.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "base/error.hpp"
#include "base/names.hpp"
#include "base/range.hpp"
#include "base/sha256.hpp"
#include "bench/catalogue/locations.hpp"
#include "bench/catalogue/option_values.hpp"
#include "datasets/native/columns.hpp"
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

namespace {

// A set may hold any finite number; sums of squares may not.
void require_range(const std::string& path, const std::vector<Recording>& recordings) {
  for (const Recording& r : recordings)
    for_each_value_column(r, 1, [&](const std::string& name, const char*, const std::vector<double>& values) {
      for (std::size_t k = 0; k < values.size(); ++k)
        if (!in_range(values[k]))
          throw DataError(fmt::format(
              "{}: recording '{}': {}, sample {}: found {}, expected a number of at most {:g} in size", path,
              r.id, name, k, values[k], kLargestNumber));
    });
}

}  // namespace

LoadedProblem load_calibration(const std::string& data, InstructionSet kernel) {
  const std::filesystem::path path = data.empty() ? demo_set() : std::filesystem::path(data);
  Dataset dataset = load_dataset(path);
  if (dataset.robot.kinematics != "4wis4wid")
    throw DataError(fmt::format("{}: robot.kinematics is '{}'; the calibration problem knows 4wis4wid",
                                path.string(), dataset.robot.kinematics));
  require_range(path.string(), dataset.recordings);
  std::shared_ptr<const CalibrationProblem> model;
  try {
    model = std::make_shared<const CalibrationProblem>(robot_parameters(dataset.robot),
                                                       std::move(dataset.recordings), kernel);
  } catch (const std::invalid_argument& error) {  // what is wrong with the set is no usage error
    throw DataError(fmt::format("{}: {}", path.string(), error.what()));
  }
  dataset.recordings.clear();
  return {Problem(model), model, std::move(dataset), path.string(), sha256_of_file(path), ""};
}

namespace {

[[noreturn]] void refuse_name(const std::string& name, const std::vector<std::string>& names) {
  throw std::invalid_argument(fmt::format("unknown problem '{}'{}; 'bench list problems' shows all", name,
                                          did_you_mean(name, names)));
}

bool takes(const std::string& name, int dimension) {
  const ClassicEntry* entry = find_classic_problem(name);
  return dimension == 0 || (entry != nullptr && entry->dimensions.allows(dimension));
}

}  // namespace

std::vector<std::string> resolve_problems(const std::vector<std::string>& lists, int dimension,
                                          std::vector<std::string>& notes) {
  const std::vector<std::string> names = problem_names();
  std::vector<std::string> chosen;
  const auto take = [&](const std::string& name) {
    if (std::find(chosen.begin(), chosen.end(), name) == chosen.end()) chosen.push_back(name);
  };
  for (const std::string& item : comma_items(lists)) {
    if (item.find_first_of("*?[") == std::string::npos) {
      if (std::find(names.begin(), names.end(), item) == names.end()) refuse_name(item, names);
      take(item);
      continue;
    }
    int met = 0, left_out = 0;
    for (const std::string& name : names) {
      if (::fnmatch(item.c_str(), name.c_str(), 0) != 0) continue;
      ++met;
      if (takes(name, dimension))
        take(name);
      else
        ++left_out;
    }
    if (met == left_out)
      throw std::invalid_argument(
          fmt::format("--problem: no problem is called '{}'{}; 'bench list problems' shows all", item,
                      met == 0 ? "" : fmt::format(" and takes dimension {}", dimension)));
    if (left_out > 0)
      notes.push_back(fmt::format("{}: {} of {} problems do not take dimension {} and are left out", item,
                                  left_out, met, dimension));
  }
  return chosen;
}

std::string box_check_sum(const std::vector<ParameterInfo>& parameters) {
  std::string text;
  for (const ParameterInfo& p : parameters)
    text += fmt::format("{} {} {:a} {:a}\n", p.name, p.unit, p.lower, p.upper);
  return sha256(text).substr(0, 16);
}

LoadedProblem make_problem(const std::string& name, int dimension, const std::string& data,
                           InstructionSet kernel) {
  if (name == "calibration") {
    if (dimension != 0)
      throw std::invalid_argument("--dimension: the calibration problem has the dimension of its robot");
    return load_calibration(data, kernel);
  }
  if (find_classic_problem(name) == nullptr) refuse_name(name, problem_names());
  const bool usual = dimension == 0 || dimension == usual_dimension(name);
  return {make_classic_problem(name, dimension),        nullptr, std::nullopt, "", "",
          usual ? "" : fmt::format("[n={}]", dimension)};
}

}  // namespace odobench
