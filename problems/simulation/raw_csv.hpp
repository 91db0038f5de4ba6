// Simulated drives as the raw files that J. Vitko published: abs_i.csv (motion capture) and odom_i.csv
// (wheels).
#pragma once

#include <string>

#include "problems/simulation/recording_simulator.hpp"

namespace odobench::simulate {

// Texts of the two files of recording `number` (1, 2, ...), whose logs begin 3 minutes after those of the one
// before. Numbers are the shortest that read back as the same bits. The efforts of the motors are not
// simulated: 0.0.
std::string capture_csv(const DriveLogs& logs, int number);
std::string wheels_csv(const DriveLogs& logs, int number);

}  // namespace odobench::simulate
