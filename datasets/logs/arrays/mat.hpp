// MATLAB's .mat files: versions 5 and 7 by a reader of our own, 7.3 (HDF5) by libmatio in a process of its
// own.
#pragma once

#include "datasets/logs/log_file.hpp"

namespace odobench {

// Structs are sources, "log.signals.values" is field signals.values of source "log"; elements of a struct
// array "a[0].b"; arrays beside structs are fields of source "". Numbers of classes double to uint64 and
// logical, in whatever smaller type they are stored, int64 exact; of complex numbers the real parts. What
// MATLAB alone can read (table, timetable, datetime, string) is named with what to do in MATLAB. Limits: 512
// MiB per variable, decompressed; 16 levels of structs.
LogFormat mat_log_format();
// Without libmatio at build time (ODOBENCH_MATLAB73) opening is a DataError that says what to do.
LogFormat mat73_log_format();

}  // namespace odobench
