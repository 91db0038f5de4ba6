// Measurements of real sensors, out of files.
#pragma once

#include <vector>

#include "base/stop.hpp"
#include "problems/fusion/sensors_file.hpp"

namespace odobench {

// Reads the file of a measured sensor for this recording, a table or another log with one source: stamps in
// the recording's own time (0 at its first stamp), in s unless the column's name says another unit. `stream`:
// as make_streams() left it; gets its data, a gyro's hold time the median step. Throws DataError with
// file:line for what is no number, a column that is missing (with the nearest), stamps that do not increase.
void read_measurements(const SensorsFile& file, const SyntheticSensor& sensor, const Recording& recording,
                       SensorStream& stream, const Stop& stop);

}  // namespace odobench
