// Records of schema 1, which earlier versions wrote: "statistics" of names and numbers alone.
#pragma once

#include <string>

#include "reports/records/measure.hpp"

namespace odobench {

// The measure that a name of schema 1 stands for: unit, direction and what it is of are taken from one table,
// which holds all names that those versions wrote. A name that is not in it has no unit and no direction.
Measure schema_1_measure(const std::string& name, double value);

}  // namespace odobench
