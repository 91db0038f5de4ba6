// What `bench list suites` shows.
#pragma once

#include <vector>

#include "bench/catalogue/catalogue.hpp"
#include "reports/render/table.hpp"

namespace odobench {

// One table of all suites, then one per suite: where each problem starts, what its lowest known cost is
// and in how many points it is known to be attained, what makes it hard. Problems are made for it, but for
// robots:*, whose simulated drives take a second.
std::vector<Table> suite_tables(const Catalogue& catalogue);

}  // namespace odobench
