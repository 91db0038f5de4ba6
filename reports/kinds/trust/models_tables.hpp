// Tables of models of a robot compared on one data set (`bench models`). Such a record has problem
// kModelsProblem, kind "evaluation", the model's name as label ("plain": what the set says), its parameters,
// errors and J fitted to all recordings, and
//   measures    total            sum over trajectories of mean largest errors x, y, theta, m + rad
//               held_total       the same, of each recording by the fit without its repetition
//               held_cost        J of the recordings by those fits
//               new_kind_total   of each recording by the fit without its trajectory
//               new_kind_cost    J of the recordings by those fits
//               free             parameters inside their bounds, and those of free starts
//               on_bounds        parameters on one
//               bic              N ln(J / N) + free ln N, N: 6 per recording
//               lag              held lag, s; only where there is one
//               recommended      1 for the one that is, 0 for others
//   series      offsets.NAME     of an extra parameter, by fold: repetitions, then trajectories
//   notes       "reading: WORDS" for the column of that name, and remarks
// The first record has label "nominal": the nominal parameters of the plain model, without held-out figures
// of its own, since nothing is fitted: they are its total.
#pragma once

#include "reports/kinds/kind.hpp"

namespace odobench {

inline constexpr const char* kModelsProblem = "models";
inline constexpr const char* kReadingNote = "reading: ";

// "models" and "models.extras".
std::vector<Table> models_tables(const std::vector<RunRecord>& records);
RecordKind models_kind();

}  // namespace odobench
