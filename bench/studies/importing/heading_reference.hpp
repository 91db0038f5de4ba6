// A set whose reference is a gyro: what it cannot measure.
#pragma once

#include "datasets/dataset.hpp"

namespace odobench {

// Headings tell ratios of lengths only: the robot with all lengths times a factor turns as before. So the
// first free radius of a set of ReferenceKind::Headings is held at its nominal value (lower = upper), which
// the set's notes say, and x, y of the reference become the path that the wheels say with nominal values
// along the gyro's headings (arcs): for pictures and tables, never for a fit. Sets of other references stay
// as they are. Throws std::invalid_argument for recordings that lack signals of the robot.
void complete_heading_reference(Dataset& dataset);

}  // namespace odobench
