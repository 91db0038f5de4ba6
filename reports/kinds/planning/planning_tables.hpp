// Tables of what a set of drives can determine (`bench plan`). Such a record has problem kPlanningProblem,
// kind "evaluation", the nominal parameters, and
//   series      standard_deviations  relative, of each parameter; null when it is not determined (n)
//               singular_values      of the noise-weighted Jacobian in relative parameters, largest first (n)
//               proposed             largest standard deviation once this and the proposed drives before are
//                                    added
//               direction_deviations relative standard deviation along each of them; null: not at all (n)
//               directions           unit vectors in the same order, one after the other (n * n)
//   measures    wanted               relative standard deviation asked for
//               determined           how many parameters reach it
//               deviation.NAME       as in the series, of each parameter NAME that is determined at all
//   notes       "undetermined: COMBINATION", "proposed: DRIVE", and remarks for the first table
#pragma once

#include <vector>

#include "reports/records/record.hpp"
#include "reports/render/table.hpp"

namespace odobench {

inline constexpr const char* kPlanningProblem = "planning";
inline constexpr const char* kUndeterminedNote = "undetermined: ";
inline constexpr const char* kProposedNote = "proposed: ";
// Begins the remark on combinations for which nothing can be proposed.
inline constexpr const char* kNoCandidateNote = "No candidate tells ";

// plan.parameters, plan.directions, plan.undetermined where something is, plan.proposals where they were
// asked for (`proposals`, or the record has some).
std::vector<Table> planning_tables(const RunRecord& record, bool proposals = false);

}  // namespace odobench
