// What one recording says about itself: stamps, jumps, spikes, a reference that stands still.
#pragma once

#include <vector>

#include "problems/inspection/drive_view.hpp"
#include "problems/inspection/finding.hpp"

namespace odobench::inspection {

// In this order: gap or clock_jump, heading_wrapped, pose_outlier (one finding per coordinate), wheel_spike
// or encoder_overflow, capture_frozen. What is recognised is corrected in `drive` (a jump of the clock taken
// out, turns unwrapped, outliers and spikes replaced by medians) or marked bad.
std::vector<Finding> check_recording(const RobotView& robot, Drive& drive);

// Samples that stand out of v by more than max(floor, 10 * 1.4826 * median of e > 0, 6 * 90th percentile of
// |v_{k+1} - v_k|), e = |v - median of 7|; none where they are more than max(3, 1 %).
std::vector<Index> pose_outliers(const Vector& v, double floor);
// Entries above 8 times the 95th percentile of all; none where they are more than max(3, 0.5 %). `usual` is
// that percentile.
std::vector<Index> spikes(const Vector& magnitude, double& usual);

}  // namespace odobench::inspection
