// Odometry fused with sensors, and the noise parameters fitted for it.
#pragma once

#include "reports/kinds/kind.hpp"

namespace odobench {

RecordKind fusion_kind();
RecordKind tuning_kind();

}  // namespace odobench
