// What is compared with the reference, by which rule of integration, and with which weights.
#pragma once

#include <string>
#include <string_view>

#include "problems/robots/integration.hpp"

namespace odobench {

// Position errors (dx, dy) and heading errors dtheta that make up J:
//   EverySample  of every sample with a reference but the first; the thesis' cost (3.3)
//   FinalPose    of the last sample with a reference: a tape measure
//   Segments     of the motion from one sample row to the next, seen from the pose where it begins: errors do
//                not pile up
//   Optiodom     of the sample rows, position only: the cost of Sousa et al., J. Intell. Robot. Syst. 105:39
//                (2022)
// Sample rows: where the path by nominal parameters since the last such row reaches `distance`, and the last.
enum class CostKind { EverySample, FinalPose, Segments, Optiodom };

// "every_sample", "final_pose", "segments", "optiodom".
std::string_view name_of(CostKind kind);
// Throws std::invalid_argument for an unknown name, with the nearest one.
CostKind cost_kind(std::string_view name);

struct CalibrationOptions {
  CostKind cost = CostKind::EverySample;
  robots::IntegrationRule rule = robots::IntegrationRule::Euler;
  // J = sum position (dx^2 + dy^2) + heading dtheta^2; 1 / m^2 and 1 / rad^2, both 1 in the thesis.
  double position_weight = 1, heading_weight = 1;
  double distance = 0.5;  // between sample rows, m
  // The tracked frame sits at a place and yaw (x, y, yaw) in the body frame that are to be found too.
  bool mount = false;
  // Whether a drive begins at the origin with the reference's heading, as in the thesis, and not at the
  // reference's first pose.
  bool from_origin = false;

  // What has to be said beside J, "every_sample, euler" or "segments, arc, weights 1:4, mount".
  std::string text() const;
  // What the structured form of the thesis' robot evaluates.
  bool as_in_thesis() const;
};

}  // namespace odobench
