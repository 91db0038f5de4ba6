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
  std::string variant;  // "[n=12]" when a classic problem has another dimension than its usual one

  // In records, and what seeds are derived from: problems of different dimensions are different problems.
  std::string name() const { return problem.name() + variant; }
  std::string dataset_name() const { return dataset ? dataset->name : std::string(); }
};

// Name, unit, nominal value and box of each.
std::vector<ParameterInfo> robot_parameters(const Robot& robot);

// `data`: path of set.json, "" for the demo set. Throws DataError on a bad set or one of another kind of
// robot.
LoadedProblem load_calibration(const std::string& data, InstructionSet kernel);

// `name`: "calibration" or a classic one, which takes no `data`, with `dimension` (0: its usual one). Throws
// std::invalid_argument on an unknown name (suggests the nearest) or a dimension that the problem does not
// take; DataError as above.
LoadedProblem make_problem(const std::string& name, int dimension, const std::string& data,
                           InstructionSet kernel);

// Every name make_problem takes.
std::vector<std::string> problem_names();

// The values of --problem as names: comma lists of names and shell patterns ("nist:*", "mgh:*[!0]"), each
// name once. A pattern leaves out problems that do not take `dimension` (0: the usual one), with a line in
// `notes`. Throws std::invalid_argument on an empty item, an unknown name or a pattern that meets nothing.
std::vector<std::string> resolve_problems(const std::vector<std::string>& lists, int dimension,
                                          std::vector<std::string>& notes);

// Check sum of what the solver may choose from: names, units and bounds; 16 hexadecimal digits.
std::string box_check_sum(const std::vector<ParameterInfo>& parameters);

// The dimension meant by 0.
int usual_dimension(const std::string& classic);

}  // namespace odobench
