// Tables of drives that decide between two models (`bench plan --between`): a record of kPlanningProblem with
//   series    rival_difference   of the predicted end poses, first model minus second: x, y (m), heading
//                                (rad), drive by drive (3 * drives)
//             rival_scatter      standard deviations of one drive's end: x, y, heading (3 * drives)
//             rival_separation   D of one drive (problems/information/discrimination.hpp)
//             rival_evidence     D^2 / 2: the expected logarithm of the Bayes factor of one drive
//             rival_repetitions  how often it has to be driven for a right choice in 95 of 100; null: 100 are
//                                not enough
//             rival_seconds      how long it takes
//   measures  rival_cost.first, rival_cost.second  J of both fits to the recordings that there are
//   notes     "rivals: FIRST | SECOND", "drive: NAME | DESCRIPTION" of every drive, in the order of the
//             series: best first
#pragma once

#include <vector>

#include "reports/records/record.hpp"
#include "reports/render/table.hpp"

namespace odobench {

inline constexpr const char* kRivalsNote = "rivals: ";
inline constexpr const char* kRivalDriveNote = "drive: ";

bool has_rivals(const RunRecord& record);
// plan.between; empty for a record that has none.
std::vector<Table> rival_tables(const RunRecord& record);

}  // namespace odobench
