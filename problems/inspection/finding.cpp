#include "problems/inspection/finding.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "base/names.hpp"

namespace odobench::inspection {
namespace {

using enum Severity;

constexpr std::array kKinds = {
    Kind{"never_moved", Error, false, "record drives in which the robot moves"},
    Kind{"gap", Warning, false, "split the recording there, or leave it out"},
    Kind{"clock_jump", Error, true, "take the jump out of the stamps"},
    Kind{"heading_wrapped", Error, true, "unwrap theta"},
    Kind{"pose_outlier", Warning, true, "replace the samples by the median of their neighbours"},
    Kind{"wheel_spike", Warning, true, "replace the samples by the median of their neighbours"},
    Kind{"encoder_overflow", Error, true, "replace the samples by the median of their neighbours"},
    Kind{"capture_frozen", Warning, false, "cut the stretch out, or leave the recording out"},
    Kind{"layout_asymmetric", Warning, false, "use --twist=least_squares"},
    Kind{"heading_degrees", Error, true, "multiply theta by pi/180"},
    Kind{"heading_sign", Error, true, "negate theta"},
    Kind{"position_unit", Error, true, "convert x and y to metres"},
    Kind{"frame_mirrored", Error, true, "make the frame right-handed: x, y and theta counter-clockwise"},
    Kind{"steering_degrees", Error, true, "multiply the steering angles by pi/180"},
    Kind{"wheel_order", Error, true, "put the columns in the order of the robot's wheels"},
    Kind{"steering_sign", Error, true, "negate the steering angles"},
    Kind{"wheel_reversed", Error, true, "negate the wheel's speeds"},
    Kind{"direction_reversed", Error, true, "negate all wheel speeds, or turn the robot's frame by pi"},
    Kind{"not_together", Error, false, "look at stamps, frames and columns: nothing simple explains it"},
    Kind{"start_offset", Error, true,
         "align every drive to its first pose, or calibrate with --model=anchor"},
    Kind{"common_factor", Warning, false, "check units of wheel speeds, gear ratio and nominal radii"},
    Kind{"time_unit", Error, true, "multiply the stamps by 1000"},
    Kind{"rotation_factor", Warning, false, "check track, wheel base and the robot's sideways slip"},
    Kind{"reference_lag", Warning, true,
         "shift the reference in time, or calibrate with --model=time_offset=SECONDS"},
    Kind{"heading_turned", Warning, true, "turn theta, or calibrate with --model=heading_offset"},
    Kind{"steering_zero", Warning, false,
         "correct the zeros of the steering, or calibrate with --model=steering_zero:WHEEL"},
    Kind{"tracked_point", Warning, false, "calibrate with --model=lever_arm, or move the tracked frame"},
    Kind{"recording_unlike", Warning, false, "look at this recording, or leave it out"},
    Kind{"speeds_repeat", Warning, false, "cut the stretch out, or leave the recording out"},
    Kind{"wheel_slip", Warning, false, "leave the recording out, or use a robust cost"},
};

}  // namespace

std::string_view name_of(Severity severity) {
  return severity == Error ? "error" : severity == Warning ? "warning" : "note";
}

std::span<const Kind> kinds() {
  return kKinds;
}

const Kind& kind_called(std::string_view name) {
  const auto found =
      std::find_if(kKinds.begin(), kKinds.end(), [&](const Kind& k) { return k.name == name; });
  if (found != kKinds.end()) return *found;
  std::vector<std::string> known;
  for (const Kind& k : kKinds) known.emplace_back(k.name);
  throw std::invalid_argument(fmt::format("unknown kind of finding '{}'{}", name, did_you_mean(name, known)));
}

Finding finding_of(std::string_view kind, std::string message, std::map<std::string, double> figures) {
  const Kind& known = kind_called(kind);
  Finding f;
  f.severity = known.severity;
  f.kind = known.name;
  f.figures = std::move(figures);
  f.message = std::move(message);
  f.mendable = known.mendable;
  return f;
}

bool any_error(const std::vector<Finding>& findings) {
  return std::any_of(findings.begin(), findings.end(),
                     [](const Finding& f) { return f.severity == Severity::Error; });
}

}  // namespace odobench::inspection
