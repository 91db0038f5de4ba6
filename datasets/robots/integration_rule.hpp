// The rules by which motions per interval are summed up to poses; problems/robots/integration.hpp has the
// equations.
#pragma once

#include <string_view>

namespace odobench::robots {

enum class IntegrationRule { Euler, Midpoint, Arc, OptiodomOmni };

// "euler", "midpoint", "arc", "optiodom-omni".
std::string_view name_of(IntegrationRule rule);
// Throws std::invalid_argument for an unknown name, with the nearest one.
IntegrationRule integration_rule(std::string_view name);

}  // namespace odobench::robots
