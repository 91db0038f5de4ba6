// Which fields of a log are a pose that does not come from the robot's own wheels.
#pragma once

#include <vector>

#include "datasets/import/logs/log_roles.hpp"

namespace odobench::log_import {

// Fills roles.reference and says why.
void find_reference(const std::vector<SurveyedSource>& sources, Roles& roles);

}  // namespace odobench::log_import
