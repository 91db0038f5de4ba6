// What is wrong with a fusion, in words.
#pragma once

#include <string>
#include <vector>

#include "problems/fusion/sensors_file.hpp"
#include "reports/kinds/fusion/fusion_tables.hpp"

namespace odobench {

// Of a filtered row, beside the unfiltered row of the same parameters (null: there is none):
// - a gate that rejects more than a fifth of a sensor, with the share;
// - a gyro without a bias state whose mean difference to the wheels, a recording at a time, is further from 0
//   than three times what its own white noise and the wheels' explain (root mean square over the recordings):
//   about that bias, and the setting that estimates it;
// - a fused position or heading that is worse than that of the wheels alone.
std::vector<std::string> fusion_remarks(const SensorsFile& sensors, const FusionRow& row,
                                        const FusionRow* wheels);

}  // namespace odobench
