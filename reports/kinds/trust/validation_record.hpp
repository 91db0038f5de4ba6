// What a validation leaves in the record of the result that it judges: how large the errors are on recordings
// that the fit has not seen.
//
// Per scheme S ("repetitions": the same drives again; "trajectories": a kind of drive never seen; "kfold"):
// measures of all recordings that were judged, each by the one fit that did not see it,
//   validation.S.cost_held_out, cost_full, cost_nominal     sums of J_n at the fold's fit, at the fit to all
//                                                           recordings, at the nominal parameters
//   validation.S.total_held_out, total_full, total_nominal  their total error as in the table `totals`
//   validation.repetitions.cost_predicted                   cost_held_out as one formula predicts it
// and series
//   validation.S.fold        of each recording of RunRecord::errors the number of the fold that leaves it
//                            out, from 1; 0: none does
//   validation.S.parameters  of each fold's fit, fold by fold
//   validation.S.cost_fitted, total_fitted                  of each fold: its fit on what it fitted
//   validation.S.fold_cost_held_out, fold_cost_full, fold_cost_nominal, fold_total_held_out,
//   fold_total_full, fold_total_nominal                     of each fold, on what it leaves out
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "reports/records/record.hpp"

namespace odobench {

inline constexpr const char* kRepetitions = "repetitions";
inline constexpr const char* kTrajectories = "trajectories";
inline constexpr const char* kKFold = "kfold";

// J and total error of one set of recordings, at three points.
struct HeldOut {
  double cost_held_out = 0, cost_full = 0, cost_nominal = 0;
  double total_held_out = 0, total_full = 0, total_nominal = 0;
};

struct FoldFigures {
  std::string name;            // "2", "line_y"
  std::size_t recordings = 0;  // left out
  double cost_fitted = 0, total_fitted = 0;
  HeldOut held_out;
  std::vector<double> parameters;
};

struct SchemeFigures {
  std::string scheme;
  std::vector<double> fold_of;  // series validation.S.fold
  std::vector<FoldFigures> folds;
  HeldOut all;
  std::optional<double> cost_predicted;
};

void put_validation(const SchemeFigures& figures, RunRecord& record);

// Nothing where the record was not validated so.
std::optional<SchemeFigures> validation_of(const RunRecord& record, const std::string& scheme);
// In the order of the constants above.
std::vector<SchemeFigures> validations_of(const RunRecord& record);

// 100 (a - b) / b.
double change_percent(double a, double b);

}  // namespace odobench
