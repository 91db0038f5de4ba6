// From the two logs of a vitko2024 drive to a recording.
#pragma once

#include "datasets/import/vitko2024/vitko2024_csv.hpp"
#include "datasets/recording.hpp"

namespace odobench::vitko2024 {

// Samples that the thesis drops at the beginning of every drive.
inline constexpr std::size_t kDroppedSamples = 29;

// Unwraps the yaw, interpolates the wheel signals (linear extrapolation at both ends) onto the capture's
// stamps, drops the first kDroppedSamples and starts time at 0. Stamps must increase strictly; at least
// kDroppedSamples + 2 of the capture and 2 of the wheels. Fills the columns, no names.
Recording join(CaptureLog capture, const WheelLog& wheels);

}  // namespace odobench::vitko2024
