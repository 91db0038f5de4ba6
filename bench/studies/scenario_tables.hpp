// `bench list scenarios [SCENARIO]`: what there is, or one in detail.
#pragma once

#include <string>
#include <vector>

#include "reports/render/table.hpp"

namespace odobench {

// One row per known scenario, or for the name or file of one its drives and parameters. Throws
// std::invalid_argument on an unknown name, DataError on a bad file.
std::vector<Table> scenario_tables(const std::string& scenario);

}  // namespace odobench
