// Parameter sets judged on new drives.
#pragma once

#include "reports/kinds/kind.hpp"

namespace odobench {

RecordKind verification_kind();

}  // namespace odobench
