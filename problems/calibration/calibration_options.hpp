// What is compared with the reference, by which rule of integration, and with which weights.
#pragma once

#include <string>
#include <string_view>

#include "problems/calibration/losses/loss.hpp"
#include "problems/calibration/models/model_terms.hpp"
#include "problems/robots/integration.hpp"

namespace odobench {

// Position errors (dx, dy) and heading errors dtheta that make up J:
//   EverySample  of every sample with a reference but the first; the thesis' cost (3.3)
//   FinalPose    of the last sample with a reference: a tape measure
//   Segments     of the motion from one sample row to the next, seen from the pose where it begins: errors do
//                not pile up
//   Optiodom     of the sample rows, position only: the cost of Sousa et al., J. Intell. Robot. Syst. 105:39
//                (2022)
// Sample rows: where the nominal path since the last one reaches `distance`, and the last row; or pieces.
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
  // Of Segments and Optiodom where one is above 0: sample rows are the first samples with a reference from
  // m times this many seconds, or m times this many metres along the reference, on, m = 0, 1, ...; what comes
  // behind the last does not count, and a recording that is shorter than a piece has no residuals.
  double piece_seconds = 0, piece_metres = 0;
  // The tracked frame sits at a place and yaw (x, y, yaw) in the body frame that are to be found too.
  bool mount = false;
  // Whether a drive begins at the origin with the reference's heading, as in the thesis, and not at the
  // reference's first pose.
  bool from_origin = false;
  // Nuisance parameters and richer models of the wheels.
  ModelTerms model;

  // What large errors count for; of the squared errors with the weights above where it is one per recording.
  Loss loss;

  // What has to be said beside J, "every_sample, euler" or "segments, arc, weights 1:4, mount";
  // models behind "model:".
  std::string text() const;
  // What the structured form of the thesis' robot evaluates, the loss apart.
  bool as_in_thesis() const;
};

}  // namespace odobench
