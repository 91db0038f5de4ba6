// Run records -> comparison tables, pure functions. Layout after J. Vitko, master's thesis, University of
// Zagreb, 2024 (tables 2-7, 36-42), plus what it lacks: J, effort, stop reason, active bounds, spread over
// repeats.
//
// Records are compared within one problem and data set; several of them give several groups of tables. Within
// a group a row is a label: "nominal" first, then other evaluations, then runs, each in order of first
// appearance. The record of kind "evaluation" and label "nominal" is the reference of differences; without it
// there are none. A label run several times is represented by its median run by J (the lower one of an even
// number; runs without a cost count as worst), which a note names; its spread has a table of its own.
#pragma once

#include <string>
#include <vector>

#include "reports/records/record.hpp"
#include "reports/render/table.hpp"

namespace odobench {

// Everything, in this order, tables without content left out:
//   verdict            what the calibration comes to, in sentences (verdict_table.hpp)
//   overview           a row per label: RMS in mm and degrees, total error, effort (overview_tables.hpp)
//   found              the parameters of the best run in a sentence (overview_tables.hpp)
//   errors.TRAJECTORY  per trajectory: e_max, e_sr, sigma of x, y [m], theta [rad], difference to nominal in
//                      brackets
//   maxima, drives, ends  in the plane (reports/kinds/calibration/drive_tables.hpp)
//   parameters         in mm where the unit is m, marked U or L on a bound; lower, nominal and upper rows
//                      first
//   totals             sums of e_sr over the trajectories, total, change to nominal absolute and in %
//   validation, folds, bootstrap  recordings that the fit has not seen
//                      (reports/kinds/trust/validation_tables.hpp)
//   fit                how well each drive and all of them fit by the best row (fit_table.hpp)
//   noise, noise_kinds  the odometry's own noise (reports/kinds/trust/noise_tables.hpp)
//   determined, intervals, new_drives  how far results can be trusted (reports/kinds/trust/trust_tables.hpp)
//   solvers            J, J/J_nominal, gap to the best J, evaluations, iterations, time, stop reason, active
//                      bounds
//   repeats            median, min, max, interquartile range of J, evaluations and time; runs near the best
// and at the end, over all problems, those of reports/kinds/calibration/summary_tables.hpp.
// With several problems or data sets, ids begin with "PROBLEM.DATASET." and titles end with the names.
// `notes` (for example: which parameters are barely determined) go below the parameters that were found, else
// below the parameter table of every group that has one, else below its solver table.
std::vector<Table> comparison_tables(const std::vector<RunRecord>& records,
                                     const std::vector<std::string>& notes = {});

// For given parameters (`bench evaluate`): cost table (J, J/J_nominal), errors, parameters, totals. One
// parameter set: a single error table with the trajectories as rows; several: as above.
std::vector<Table> evaluation_tables(const std::vector<RunRecord>& records,
                                     const std::vector<std::string>& notes = {});

}  // namespace odobench
