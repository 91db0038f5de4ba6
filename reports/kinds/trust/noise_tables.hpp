// Tables of the odometry's own noise.
#pragma once

#include <vector>

#include "reports/render/table.hpp"
#include "reports/statistics/row_groups.hpp"

namespace odobench {

// Of the first row of the comparison whose record has noise figures (noise_record.hpp), the best run of a
// calibration; nothing without:
//   noise        a row per term: as standard deviation after one metre or radian with its 95 % interval, as
//                variance or covariance in SI; below it what left-out drives say of it
//   noise_kinds  a row per kind of drive: what repeats (bias), what does not (scatter), what the model says
//                of that, NEES
std::vector<Table> noise_tables(const Comparison& comparison);

}  // namespace odobench
