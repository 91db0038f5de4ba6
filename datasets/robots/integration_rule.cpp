#include "datasets/robots/integration_rule.hpp"

#include <fmt/format.h>

#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/names.hpp"

namespace odobench::robots {
namespace {

constexpr std::array<std::string_view, 4> kRuleNames = {"euler", "midpoint", "arc", "optiodom-omni"};

}  // namespace

std::string_view name_of(IntegrationRule rule) {
  return kRuleNames[static_cast<std::size_t>(rule)];
}

IntegrationRule integration_rule(std::string_view name) {
  for (std::size_t i = 0; i < kRuleNames.size(); ++i)
    if (name == kRuleNames[i]) return static_cast<IntegrationRule>(i);
  throw std::invalid_argument(
      fmt::format("unknown integration rule '{}'{}; there are euler, midpoint, arc, optiodom-omni", name,
                  did_you_mean(name, {kRuleNames.begin(), kRuleNames.end()})));
}

}  // namespace odobench::robots
