// Scenarios on disk: JSON as described in docs/simulation.md and by datasets/scenarios/schema.json. Every key
// is optional except schema, schema_version, kind and name; what is absent has the default of scenario.hpp.
#pragma once

#include <filesystem>
#include <string>

#include "base/json_node.hpp"
#include "problems/simulation/scenario.hpp"

namespace odobench::simulate {

inline constexpr const char* kScenarioSchema = "odobench-scenario";
inline constexpr int kScenarioSchemaVersion = 1;

// What every scenario says about itself.
struct ScenarioHead {
  std::string kind;  // "recordings" (here) or "dynamics" (a robot with motors)
  std::string name, description;
};

// Checks schema, version and kind. Throws DataError "file: /path: found ..., expected ...".
ScenarioHead read_head(const JsonNode& root);

// Of kind "recordings"; unknown keys, wrong types and everything that validate() refuses are DataErrors.
RecordingScenario read_scenario(const JsonNode& root);

// "truth" and "believed" of a robot: "nominal", or an object with some or all of a1 .. r4 in metres; the
// others are nominal.
Parameters read_parameters(const JsonNode& node, const Robot& robot);

}  // namespace odobench::simulate
