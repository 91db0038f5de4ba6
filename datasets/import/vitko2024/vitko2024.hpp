// Import of the recordings that J. Vitko published with his thesis: 30 drives as pairs abs_i.csv (motion
// capture) and odom_i.csv (wheels), github.com/JakVit/4WIS4WID_parameter_calibration at commit 862117d.
#pragma once

#include <filesystem>
#include <functional>

#include "datasets/dataset.hpp"

namespace odobench {

// Called with (recordings done, recordings in all) as they finish, from one thread at a time, though not
// always the caller's. What it throws ends the import and is passed on.
using ImportProgress = std::function<void(int done, int total)>;

// folder holds the 60 files, or a folder dataset/ that does (a clone). Sums are checked where it has a
// SHA256SUMS.
//   - Pairs are numbered from 1 without a gap. Thirty are the published drives, six trajectories five times
//     each; any other number becomes that many repetitions of one trajectory "drive". A folder whose
//     SHA256SUMS lists more is refused.
//   - Columns are found by the names in the header line, wheels by the names in the lists (FL, BL, BR, FR =
//   1, 2, 3, 4).
//   - time (local wall time, "2024/05/03/12:34:34.823195") becomes integer microseconds; a stamp not later
//   than the one
//     before it is set 1 us after it and counted in Dataset::notes (synchronise.hpp).
//   - theta = atan2(2(wz + xy), 1 - 2(y^2 + z^2)), rad, unwrapped.
//   - Wheel signals are interpolated linearly, and extrapolated linearly at both ends, onto the
//   motion-capture stamps.
//   - The first 29 samples are dropped; time is 0 at the 30th.
// Threads: 0 = as many as the machine has; the result does not depend on it. Throws DataError "file:line:
// ..." about a missing file, a wrong sum, a row with another number of fields than the header, a list with
// another number of entries than there are names, an unknown or repeated wheel name, what is no finite number
// or time, a quaternion whose norm is not 1 within 10 %, a clock that goes back by more than 10 ms, fewer
// than 31 motion-capture or 2 wheel rows, and wheel rows that begin or end more than 1 s inside the motion
// capture's time.
// drop_lost: captured samples whose tracking was lost (a quaternion whose norm is not 1 within 10 %,
// not-a-number) are left out and counted in Dataset::notes.
Dataset import_vitko2024(const std::filesystem::path& folder, const ImportProgress& progress = {},
                         int threads = 0, bool drop_lost = false);

}  // namespace odobench
