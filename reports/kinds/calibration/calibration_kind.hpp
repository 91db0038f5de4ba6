// Results of calibrations and of other problems that solvers are run on, compared with each other.
#pragma once

#include "reports/kinds/kind.hpp"

namespace odobench {

RecordKind calibration_kind();

}  // namespace odobench
