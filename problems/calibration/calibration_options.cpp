#include "problems/calibration/calibration_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

#include "base/names.hpp"
#include "base/text.hpp"

namespace odobench {
namespace {

constexpr std::array<std::string_view, 4> kCostNames = {"every_sample", "final_pose", "segments", "optiodom"};

}  // namespace

std::string_view name_of(CostKind kind) {
  return kCostNames[static_cast<std::size_t>(kind)];
}

CostKind cost_kind(std::string_view name) {
  const auto found = std::find(kCostNames.begin(), kCostNames.end(), name);
  if (found == kCostNames.end())
    throw std::invalid_argument(
        fmt::format("unknown cost '{}'{}; expected every_sample, final_pose, segments or optiodom",
                    shown(name), did_you_mean(std::string(name), {kCostNames.begin(), kCostNames.end()})));
  return static_cast<CostKind>(found - kCostNames.begin());
}

std::string CalibrationOptions::text() const {
  std::string text = fmt::format("{}, {}", name_of(cost), robots::name_of(rule));
  if (cost == CostKind::Segments || cost == CostKind::Optiodom) {
    if (piece_seconds > 0)
      text += fmt::format(", pieces of {:g} s", piece_seconds);
    else if (piece_metres > 0)
      text += fmt::format(", pieces of {:g} m", piece_metres);
    else if (distance != 0.5)
      text += fmt::format(", every {:g} m", distance);
  }
  if (position_weight != 1 || heading_weight != 1)
    text += fmt::format(", weights {:g}:{:g}", position_weight, heading_weight);
  if (mount) text += ", mount";
  if (loss.robust()) text += ", " + loss.text();
  if (model.any()) text += ", model:" + model.text();
  return text;
}

bool CalibrationOptions::as_in_thesis() const {
  return cost == CostKind::EverySample && rule == robots::IntegrationRule::Euler && position_weight == 1 &&
         heading_weight == 1 && !mount && from_origin && !model.any();
}

}  // namespace odobench
