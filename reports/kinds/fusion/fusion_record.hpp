// Rows of `bench fuse` as records: problem kFusionProblem, kind "evaluation", the errors of each recording,
// the verdict as message, the sensors in words as notes, and
//   measures    rmse_position [m], rmse_heading [rad]; of a filter also nees_mean, nees_inside, nees_lower,
//               nees_upper and sensor.NAME.FIGURE of the sensor NAME, FIGURE used | rejected | late | nis |
//               dof | lower | upper
//   series      nees: mean over the recordings at each of equally spaced instants, of a filter
#pragma once

#include "reports/kinds/fusion/fusion_tables.hpp"

namespace odobench {

inline constexpr const char* kFusionProblem = "fusion";

void put_fusion_row(const FusionRow& row, RunRecord& record);
FusionRow fusion_row(const RunRecord& record);

}  // namespace odobench
