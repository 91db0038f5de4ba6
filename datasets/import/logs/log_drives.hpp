// From curves to recordings: one clock, one grid, drives without gaps.
//
// Without a reference the stamps are those of the first wheel; start (0, 0, 0) and end are where it stands,
// the end as (0, 0, 0) until end_poses.hpp knows it. Where the reference comes at 10 Hz or more the stamps
// are its own; else those of the wheels and the reference together, and the reference stands at its own only.
// With A(t) a drive's angle, linear between its stamps,
//     increment[j] = A(t[j]) - A(t[j-1]),   increment[0] = 0,
// so that the sum over a drive is exact; a steering angle is taken at the middle of (t[j-1], t[j]). The
// tracked frame (x, y, theta)_m with its mount (mx, my, yaw) in the robot's frame gives the robot's pose
//     theta = theta_m - yaw,   (x, y) = (x, y)_m - R(theta) (mx, my).
#pragma once

#include <map>
#include <string>
#include <vector>

#include "datasets/import/logs/log_curves.hpp"
#include "datasets/import/logs/log_map.hpp"
#include "datasets/recording.hpp"
#include "datasets/sensor_rows.hpp"

namespace odobench::log_import {

struct Mount {
  double x = 0, y = 0, yaw = 0;  // m, rad
};

struct LogDrives {
  std::vector<Recording> recordings;             // without trajectory, repetition and id
  std::vector<std::vector<SensorRows>> sensors;  // of each
  std::vector<std::string> names;                // of marks; "" where there is none
  std::vector<std::string> notes;                // what was cut off, split and left out, with counts
};

// By what the map says of drives, limits and splitting. `offsets`: by how much the clocks of sources run
// ahead beside what the map says [s]. DataError where reference and wheels overlap nowhere, and where no part
// is long enough.
LogDrives make_drives(const LogMap& map, const LogCurves& curves, const Mount& mount,
                      const std::map<std::string, double>& offsets = {});

}  // namespace odobench::log_import
