// What a set of drives can determine.
#pragma once

#include "reports/kinds/kind.hpp"

namespace odobench {

RecordKind planning_kind();

}  // namespace odobench
