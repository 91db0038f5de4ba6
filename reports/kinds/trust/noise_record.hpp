// What a record says of the noise of a calibrated odometry (problems/trust/odometry_noise.hpp has the model).
//
// Measures, `of` the term or the kind of drive:
//   noise.TERM, noise.TERM.lower, noise.TERM.upper       95 %; absent where the drives do not tell
//   noise.TERM.total                                     the same with what repeats counted as noise
//   noise.speed [m/s], noise.turn_rate [rad/s]           of the drives
//   noise.metres, noise.radians, noise.drives            driven, turned, by so many drives
//   noise.separated                                      1 where repetitions tell bias from noise, else 0
//   noise.nees, noise.nees_lower, noise.nees_upper, noise.checked   left-out drives; absent without
//   noise.kind.KIND.FIGURE                               drives, bias_x, .. (kNoiseKindFigures)
// Series noise.length.metres, .radians, .segments, .ratio: one entry per length of the parts.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "reports/records/record.hpp"

namespace odobench {

struct NoiseTermFigures {
  std::string name, unit;
  double value = 0, lower = 0, upper = 0;
  double total = 0;  // the same with what repeats counted as noise
};

struct NoiseKindFigures {
  std::string kind;
  double drives = 0, repeated = 0;
  double bias_x = 0, bias_y = 0,
         bias_heading = 0;  // of the end, odometry minus reference, frame of the start
  double scatter_x = 0, scatter_y = 0, scatter_heading = 0;        // standard deviation over the repetitions
  double predicted_x = 0, predicted_y = 0, predicted_heading = 0;  // by the model, with the reference's noise
  double nees = 0;                                                 // of left-out drives; not-a-number without
};

struct NoiseLengthFigures {
  double metres = 0, radians = 0, segments = 0, ratio = 0;
};

struct NoiseFigures {
  std::vector<NoiseTermFigures> terms;  // in the order of the names below, those that the drives tell
  double speed = 0, turn_rate = 0, metres = 0, radians = 0, drives = 0;
  bool separated = false;
  double checked = 0, nees = 0, nees_lower = 0, nees_upper = 0;
  std::vector<NoiseKindFigures> kinds;
  std::vector<NoiseLengthFigures> lengths;

  const NoiseTermFigures* find(const std::string& name) const;
  // 0 where the drives do not tell.
  double value(const std::string& name) const;
  bool consistent() const { return checked > 0 && nees >= nees_lower && nees <= nees_upper; }
};

// Names of the terms as records have them, and what they are in a few words.
struct NoiseTermName {
  const char* name;
  const char* meaning;
  const char* root_unit;  // of the square root, "mm/√m"; "" of covariances
  double root_scale;      // from SI
};
inline constexpr std::array<NoiseTermName, 13> kNoiseTermNames{{
    {"along_per_metre", "along the travel, per metre", "mm/√m", 1000},
    {"across_per_metre", "across the travel, per metre", "mm/√m", 1000},
    {"heading_per_metre", "heading, per metre", "deg/√m", 57.29577951308232},
    {"forward_per_radian", "along the body, per radian", "mm/√rad", 1000},
    {"sideways_per_radian", "across the body, per radian", "mm/√rad", 1000},
    {"heading_per_radian", "heading, per radian", "deg/√rad", 57.29577951308232},
    {"capture_position", "reference: position", "mm", 1000},
    {"capture_heading", "reference: heading", "deg", 57.29577951308232},
    {"capture_stamp", "reference: stamps", "ms", 1000},
    {"along_heading_per_metre", "covariance of along and heading, per metre", "", 1},
    {"across_heading_per_metre", "covariance of across and heading, per metre", "", 1},
    {"forward_heading_per_radian", "covariance of forward and heading, per radian", "", 1},
    {"sideways_heading_per_radian", "covariance of sideways and heading, per radian", "", 1},
}};

void put_noise(const NoiseFigures& figures, RunRecord& record);
// Nothing where the record says nothing of it.
std::optional<NoiseFigures> noise_figures(const RunRecord& record);

}  // namespace odobench
