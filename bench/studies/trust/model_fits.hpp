// One model of a robot, fitted to all recordings and to folds.
#pragma once

#include <string>
#include <vector>

#include "base/stop.hpp"
#include "bench/studies/trust/fold_plan.hpp"
#include "bench/studies/trust/models_study.hpp"
#include "problems/calibration/recording_costs.hpp"

namespace odobench {

// A parameter this near to a bound counts as on it, of the width of its box.
inline constexpr double kOnBound = 1e-6;

struct FoldFit {
  std::string left_out;
  Vector z;
};

struct ModelFits {
  std::string label;
  ModelTerms terms;
  std::vector<ParameterInfo> parameters;
  std::size_t own = 0;  // how many of them the plain model has
  Vector z;
  double cost = 0;
  int free = 0, on_bounds = 0;
  std::int64_t evaluations = 0;
  std::vector<MaxErrors> errors;  // of all recordings, from the usual start
  std::vector<FoldFit> repetitions, trajectories;
  std::vector<MaxErrors> held_errors, new_kind_errors;
  double held_cost = 0, new_kind_cost = 0;
  std::vector<double> start_headings;  // of free starts, by recording, rad; empty without
  std::vector<int> senses;             // of turning by more than 1 rad, by recording: 1 left, -1 right, or 0
};

// Sum over trajectories of the mean over recordings of largest errors x + y + theta (table 42 of the thesis).
double error_total(const std::vector<MaxErrors>& errors);

// Fills `fits`, whose label and terms are given. plain: the same calibration without a model.
void fit_model(const CalibrationProblem& plain, const Robot& robot, const std::vector<Fold>& repetitions,
               const std::vector<Fold>& trajectories, const Stop& stop, ModelFits& fits);

}  // namespace odobench
