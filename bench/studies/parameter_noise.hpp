// The noise of the odometry in parameters/LABEL.json (docs/noise.md):
//   "noise": {"terms": {TERM: {"value", "lower", "upper", "total", "unit"}, ..}, "speed", "turn_rate",
//             "metres", "radians", "drives", "separated",
//             "check": null or {"drives", "nees", "lower", "upper"}}
// Terms that the drives do not tell are absent. Kinds and lengths stand in the record alone.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "base/json_node.hpp"
#include "reports/kinds/trust/noise_record.hpp"

namespace odobench {

nlohmann::ordered_json noise_json(const NoiseFigures& figures);
// DataError names the place; a term that is unknown or negative where it is a variance is refused.
NoiseFigures noise_from(const JsonNode& node);

}  // namespace odobench
