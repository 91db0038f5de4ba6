// A problem with all that records say of it, and calibrations made of data sets.
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
  std::string variant;  // "[n=12]" when a classic problem has another dimension than its usual one,
                        // "[segments,arc]" where a calibration is not as in the thesis
  std::vector<std::string> remarks = {};  // what whoever calibrates this robot should know, a sentence each

  // In records, and what seeds are derived from: problems of different dimensions are different problems.
  std::string name() const { return problem.name() + variant; }
  std::string dataset_name() const { return dataset ? dataset->name : std::string(); }
};

// Name, unit, nominal value and box of each.
std::vector<ParameterInfo> robot_parameters(const Robot& robot);

// What the command line says about J; the rest is as the set has it.
struct CalibrationChoice {
  std::optional<CostKind> cost;  // none: every sample
  std::optional<robots::IntegrationRule> rule;
  std::optional<TwistRule> twist;
  double position_weight = 1, heading_weight = 1;
  double distance = 0.5;  // between sample rows, m
  bool mount = false;
};

// The options of a calibration of this robot: its rule, its start, what the choice says.
CalibrationOptions calibration_options(const Robot& robot, const CalibrationChoice& choice = {});

// `data`: path of set.json, "" for the demo set. Throws DataError on a bad set, std::invalid_argument on a
// choice that the robot of the set does not allow.
LoadedProblem load_calibration(const std::string& data, InstructionSet kernel,
                               const CalibrationChoice& choice = {});

// Throws DataError where the robot is not the thesis', which is all that fusion knows.
void require_4wis4wid(const LoadedProblem& loaded, const char* what);

// Check sum of what the solver may choose from: names, units and bounds; 16 hexadecimal digits.
std::string box_check_sum(const std::vector<ParameterInfo>& parameters);

}  // namespace odobench
