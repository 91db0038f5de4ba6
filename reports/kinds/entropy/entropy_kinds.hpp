// Runs of the relative-entropy filter, and its windows solved by several methods.
#pragma once

#include "reports/kinds/kind.hpp"

namespace odobench {

RecordKind filter_kind();
RecordKind windows_kind();

}  // namespace odobench
