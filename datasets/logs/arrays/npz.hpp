// NumPy's .npz (a zip archive of arrays, stored or deflated, also zip64) and .npy.
#pragma once

#include "datasets/logs/log_file.hpp"

namespace odobench {

// Arrays of integers, floats and bool with one or two dimensions (of three and more, all but the first are
// columns), in both orders. Which arrays belong together: an array whose last word tells time ("ticks_t",
// "ticks_time_ns", "imu/stamp") makes what stands before that word a source, and every array that begins with
// it a field: ticks_t and ticks_count are t and count[0], count[1] of source "ticks". All others are fields
// of source "". Objects (pickles) and texts are refused.
LogFormat npz_log_format();
// One array: fields "#1", "#2" ... of source "".
LogFormat npy_log_format();

}  // namespace odobench
