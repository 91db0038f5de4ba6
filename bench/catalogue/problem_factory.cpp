#include "bench/catalogue/problem_factory.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

#include "base/error.hpp"
#include "base/range.hpp"
#include "base/sha256.hpp"
#include "bench/catalogue/locations.hpp"
#include "datasets/native/columns.hpp"

namespace odobench {

std::vector<ParameterInfo> robot_parameters(const Robot& robot) {
  std::vector<ParameterInfo> list;
  for (const RobotParameter& p : robot.parameters)
    list.push_back({p.name, p.unit, p.nominal, p.lower, p.upper});
  return list;
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

std::string box_check_sum(const std::vector<ParameterInfo>& parameters) {
  std::string text;
  for (const ParameterInfo& p : parameters)
    text += fmt::format("{} {} {:a} {:a}\n", p.name, p.unit, p.lower, p.upper);
  return sha256(text).substr(0, 16);
}

}  // namespace odobench
