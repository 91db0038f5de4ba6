// What a gyro says while the robot stands: its bias.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "datasets/import/logs/log_curves.hpp"
#include "datasets/import/logs/log_map.hpp"
#include "datasets/sensor_rows.hpp"

namespace odobench::log_import {

// Mean, deviation and duration over the stamps of `gyro` at which every drive of `signals` (of the map, in
// its order) turns by at most 0.01 rad within a quarter of a second to either side; nothing where they are
// fewer than three or last less than half a second. Stamps by the robot's clock are those of the curves less
// `offsets` of their sources [s].
std::optional<Standing> gyro_standing(const LogMap& map, const std::vector<Curve>& signals, const Curve& gyro,
                                      const std::map<std::string, double>& offsets = {});

}  // namespace odobench::log_import
