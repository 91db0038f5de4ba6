// All readers of logs that are tables.
#pragma once

#include <vector>

#include "datasets/logs/log_file.hpp"

namespace odobench {

// In the order in which they should be asked: those with magic bytes, JSON lines, the trajectories, CSV last
// (which takes any text).
const std::vector<LogFormat>& table_log_formats();

}  // namespace odobench
