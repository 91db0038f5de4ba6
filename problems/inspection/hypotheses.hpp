// Which one simple fault would explain that wheels and reference do not fit.
#pragma once

#include <vector>

#include "problems/inspection/drive_set.hpp"
#include "problems/inspection/finding.hpp"

namespace odobench::inspection {

// Sums over all drives; brings used samples up to date.
Sums sums_of(const RobotView& robot, DriveSet& drives);

// Where the misfit E is above 0.06: headings in degrees or clockwise, positions in mm, cm or inches, a
// mirrored frame, steering in degrees, columns of wheels exchanged, steering angles that count the other way;
// one of them at a time. The one with the smallest score (drive_view.hpp), if it brings E below a third, is
// said and corrected in `drives`. Then wheels with k_i < -0.3 median |k| roll backwards.
std::vector<Finding> check_hypotheses(const RobotView& robot, DriveSet& drives);

// u_i.m_j summed over the used samples of all drives: what wheel i would say with the columns of wheel j. Of
// driven wheels; row i, column j.
Matrix exchange_sums(const RobotView& robot, const DriveSet& drives);

}  // namespace odobench::inspection
