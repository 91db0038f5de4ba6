// `bench export`: trajectories of stored runs for other programs.
//
// Trajectories in the format of the TUM RGB-D benchmark: lines "time x y z qx qy qz qw", seconds and metres,
// z = 0, the heading as a unit quaternion about z; OUT/LABEL/RECORDING.tum, the motion capture as
// OUT/reference/RECORDING.tum.
#pragma once

#include "bench/verbs/verb.hpp"

namespace odobench {

VerbAction add_export(CLI::App& app);

}  // namespace odobench
