// Models of a robot compared by recordings that they were not fitted to: the study behind `bench models`.
#pragma once

#include <string>
#include <vector>

#include "base/stop.hpp"
#include "bench/catalogue/problem_factory.hpp"
#include "bench/studies/watcher.hpp"
#include "reports/records/record.hpp"

namespace odobench {

struct ModelsStudy {
  std::string data;  // path of set.json; empty: the demo set
  CalibrationChoice calibration;
  // Names that are combined by '+' ("least_squares+contact_offset"); none: those that suit the robot.
  std::vector<std::string> models;
  std::optional<InstructionSet> kernel;
  int threads = 0;  // 0: one per core; results do not depend on it
};

// The model that names joined by '+' say; "" for none. Throws as model_terms().
ModelTerms model_of_text(const std::string& text);

// The lag that inspection measures, to the millisecond, s; 0 where it finds none, or one per recording.
double measured_lag(const LoadedProblem& loaded, int threads);

// Trajectories on the spot, by how they begin: "rotation" of rotation_ccw and rotation_cw; "" for none, and
// where all are.
std::string turning_kind(const std::vector<Recording>& recordings);

// Model lists that suit the robot and its recordings, the plain one ("") first: twists, contacts, zeros, the
// tracked frame, free starts, the lag that cross-correlation measures (`lag`, s; 0: none) held, one factor
// on drives that turn on the spot. Those that the robot has nothing for are left out.
std::vector<std::string> suitable_models(const CalibrationProblem& plain, const Robot& robot, double lag);

// Records of reports/kinds/trust/models_tables.hpp, "nominal" first. Every model is fitted by `lm` from its
// nominal parameters; those whose offsets or zeros are free one by one also from the optimum of their shared
// offset and from three points of the box; every fold from all of their optima. Throws std::invalid_argument
// on a model that is none or that the robot does not allow, DataError on a bad set, Interruption.
std::vector<RunRecord> compare_models(const ModelsStudy& study, Watcher& watcher, const Stop& stop);

}  // namespace odobench
