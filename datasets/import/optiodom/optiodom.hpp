// Import of the drives that R. B. Sousa, M. R. Petry, P. G. Costa and A. P. Moreira published with "OptiOdom:
// a Generic Approach for Odometry Calibration of Wheeled Mobile Robots", J. Intell. Robot. Syst. 105:39, 2022
// (github.com/sousarbarb/odometry-calibration, folder data/), and of others in their layout.
#pragma once

#include <filesystem>
#include <vector>

#include "datasets/dataset.hpp"

namespace odobench {

struct OptiodomOptions {
  std::vector<int> exclude;  // numbers of runs that are left out, in every folder
};

// Each folder is one of TYPE/PATH/STAMP with STAMP_metadata.csv and STAMP_run-01.csv, ...; TYPE (diff,
// tricyc, omni3, omni4) must be the same in all of them.
//   - The robot is of the class differential, tricycle, omni3 or mecanum; nominal values are those of the
//     first folder's metadata, radii half of its diameters, lx and ly half of the distances of omni4, which
//     gives whole ones; boxes by default, the rollers' angle held at 45 degrees.
//   - Wheels become increments in rad: counts times 2 pi / (ngear encRes), the right wheels of omni4 with the
//     other sign. The file's steering angle is in rad. Stamps are multiples of the type's step: 50 ms (diff,
//     tricyc), 40 ms (omni3), 10 ms (omni4). Every row has a reference.
//   - Trajectories are named after PATH and the sense in which the reference turned: more than a quarter turn
//     clockwise "square_cw", counter-clockwise "square_ccw", less "square"; of PATH "ivanjko" "line",
//     "turn_cw", "turn_ccw"; "free" and "joystick" without sense. Where two folders have one PATH, "_STAMP"
//     follows. A run's number is its repetition, "STAMP_run-NN" its id.
//   - Notes count what was left out, and say where metadata of folders differ or state another number of
//     runs.
// Throws std::invalid_argument for no folder, an empty name, one that is given twice, an excluded number that
// no folder has, and where nothing is left; DataError "file:line: ..." or "file: ..." for a folder without
// exactly one metadata file or without runs, other types, and everything parse_metadata() and parse_run()
// refuse.
Dataset import_optiodom(const std::vector<std::filesystem::path>& folders,
                        const OptiodomOptions& options = {});

}  // namespace odobench
