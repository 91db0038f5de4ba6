// What a calibration that ends on the walls of its box with headings off by a factor has to say.
#pragma once

#include <string>

#include "bench/catalogue/problem_factory.hpp"
#include "reports/records/record.hpp"

namespace odobench {

// "" unless parameters of the record sit on bounds and the robot turned by another factor than odometry with
// them says (2 %, the same within 10 % in every drive that turns by more than a radian): then the sentence
// with the factor, sum(reference odometry) / sum(odometry^2) of total turns. Where one factor for all
// lengths of a kind ("a" of a1..a4) brings the cost of the nominal parameters below a tenth of the record's
// and leaves the box, it says which.
std::string wall_remark(const LoadedProblem& loaded, const RunRecord& record);

}  // namespace odobench
