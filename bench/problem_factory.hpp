// From a data set or a classic function's name to a problem that solvers take.
#pragma once

#include <memory>
#include <optional>

#include "datasets/dataset.hpp"
#include "problems/calibration/calibration_problem.hpp"
#include "problems/problem.hpp"

namespace odobench {

struct LoadedProblem {
  Problem problem;
  std::shared_ptr<const CalibrationProblem> calibration;  // null for a classic problem
  std::optional<Dataset> dataset;  // without its recordings, which the calibration problem holds
  std::string dataset_path;
  std::string dataset_sha256;

  std::string dataset_name() const { return dataset ? dataset->name : std::string(); }
};

// Name, unit, nominal value and box of each.
std::vector<ParameterInfo> robot_parameters(const Robot& robot);

// `data`: path of set.json, "" for the demo set. Throws DataError on a bad set or one of another kind of
// robot.
LoadedProblem load_calibration(const std::string& data, InstructionSet kernel);

// `name`: "calibration" or a classic one, with `dimension` (0: its usual one). Throws std::invalid_argument
// on an unknown name (suggests the nearest), a dimension or data set the problem does not take; DataError as
// above.
LoadedProblem make_problem(const std::string& name, int dimension, const std::string& data,
                           InstructionSet kernel);

// Every name make_problem takes.
std::vector<std::string> problem_names();

// The dimension meant by 0.
int usual_dimension(const std::string& classic);

}  // namespace odobench
