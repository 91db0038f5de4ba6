// Sets without the faults that were found in them.
#pragma once

#include <string>
#include <vector>

#include "datasets/dataset.hpp"
#include "problems/inspection/finding.hpp"

namespace odobench::inspection {

// Changes `dataset` by every finding that can be mended, in the order in which they were found, notes each
// change in its notes and returns what was changed, a sentence without full stop each. `findings`: those of
// this set.
//   columns, units, signs  as the finding says; a diameter entered as radius halves nominal radii and boxes
//   outliers, spikes       replaced by the median of seven neighbours
//   clock_jump             the gap becomes one usual step
//   start_offset           every drive moved so that it begins at (0, 0); headings stay what they are
//   reference_lag          reference(t + lag) by linear interpolation; samples without one are cut off
std::vector<std::string> mend(Dataset& dataset, const std::vector<Finding>& findings);

}  // namespace odobench::inspection
