// A problem with all that records say of it, and calibrations made of data sets.
#pragma once

#include <memory>
#include <optional>

#include "datasets/dataset.hpp"
#include "problems/calibration/calibration_problem.hpp"
#include "problems/problem.hpp"
#include "problems/trust/recordings_apart.hpp"
#include "problems/trust/sibling_screening.hpp"

namespace odobench {

// A recording that differs from its siblings and takes no part in J.
struct SetAside {
  Recording recording;
  std::size_t place = 0;  // among the recordings of the set
  double z = 0;           // of problems/trust/sibling_screening.hpp
};

struct LoadedProblem {
  Problem problem;
  std::shared_ptr<const CalibrationProblem> calibration;  // null for a classic problem
  std::optional<Dataset> dataset;  // without its recordings, which the calibration problem holds
  std::string dataset_path;
  std::string dataset_sha256;
  std::string variant;  // "[n=12]" when a classic problem has another dimension than its usual one,
                        // "[segments,arc]" where a calibration is not as in the thesis
  std::vector<std::string> remarks = {};  // what whoever calibrates this robot should know, a sentence each
  // What was left out, and a sentence for each; the recordings as a problem of their own, null without any.
  std::vector<SetAside> set_aside = {};
  std::vector<std::string> left_out = {};
  std::shared_ptr<const CalibrationProblem> aside = nullptr;
  // Where runs begin that are not told otherwise, with its name; empty: at the problem's own start.
  std::string start_name = {};
  Vector start = {};
  std::shared_ptr<const RecordingsApart> apart = {};  // of a calibration: its recordings one by one

  // In records, and what seeds are derived from: problems of different dimensions are different problems.
  std::string name() const { return problem.name() + variant; }
  // All recordings of the set in their order, copied where some were left out.
  std::vector<Recording> all_recordings() const;
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
  double piece_seconds = 0, piece_metres = 0;  // of sample rows; 0: `distance`
  bool estimate_weights = false;               // from the errors of the data, instead of the two above
  Loss loss;                                   // without scales
  std::vector<double> loss_scale;              // m, rad, or one of a loss per recording; none: estimated
  // Recordings whose z is above it are left out; 0: nobody looks.
  double screen = 0;
  std::optional<std::vector<std::string>> model;  // none: as the set has it
};

// What the reference's kind leaves: segments of another odometry unless a cost is asked for; headings alone
// (position weight 0, of segments unless a cost is asked for) of a gyro. Throws std::invalid_argument for
// costs, weights and a mount that a gyro's headings do not have.
CalibrationChoice choice_for(ReferenceKind kind, CalibrationChoice choice);

// As it is without options, with screening.
CalibrationChoice screened();

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
