// JSON lines: a JSON document per line.
#pragma once

#include "datasets/logs/log_file.hpp"

namespace odobench {

// A source per value of the key "topic"; lines without one are source "". Fields are paths: nested objects
// "a.b", elements of arrays "a[0]" (the first 16 of an array are listed, any can be asked for). Time is the
// first field whose name tells time ("t", "stamp_ns") and whose values do, else the first whose values do.
// Duplicate keys: the last one counts. Lines of at most 1 MiB, 32 levels.
LogFormat json_lines_log_format();

}  // namespace odobench
