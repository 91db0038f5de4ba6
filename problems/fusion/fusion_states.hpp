// The filter over one recording, compiled once for each state that there is: two choices instead of eight,
// since each takes half a minute to compile; an unused bias or scale has no variance and stays 0. Arguments
// as of fuse(), and valid.
#pragma once

#include "problems/fusion/fusion.hpp"

namespace odobench {

// The pose alone.
FusionResult fuse_plain(const Recording& recording, const ConstVectorRef& z,
                        std::span<const SensorStream> sensors, const FusionOptions& options,
                        bool keep_innovations);
// With the gyro's bias, the odometry's scale and a copy of the pose.
FusionResult fuse_augmented(const Recording& recording, const ConstVectorRef& z,
                            std::span<const SensorStream> sensors, const FusionOptions& options,
                            bool keep_innovations);

}  // namespace odobench
