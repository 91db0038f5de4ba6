// Trajectories of references as other programs write them: tables whose columns are known. The fields x and
// y [m] are in the plane of the ground, z is up, heading [rad] is the angle of the body's forward axis from x
// towards y, qx, qy, qz, qw the orientation in these axes.
//   TUM      t x y z qx qy qz qw, blanks, seconds
//   EuRoC    t,x,y,z,qw,qx,qy,qz,..., nanoseconds; w first
//   KITTI    the 12 numbers of [R|t] row by row; times in STEM_times.txt or times.txt beside
//   Motive   OptiTrack's CSV export 1.2x: five lines of header, y up; one source per rigid body
// The plane is option `plane`, else of TUM and EuRoC xy; of Motive zx; of KITTI the one about whose normal
// the body turns (xz: camera axes, z forward, y down). The type of the source says it: "trajectory (TUM,
// plane xy)".
#pragma once

#include <vector>

#include "datasets/logs/log_file.hpp"

namespace odobench {

LogFormat tum_log_format();
LogFormat euroc_log_format();
LogFormat kitti_log_format();
LogFormat motive_log_format();

}  // namespace odobench
