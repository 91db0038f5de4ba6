// Gyro and camera of a log, drive by drive.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "datasets/import/logs/log_curves.hpp"
#include "datasets/import/logs/log_map.hpp"
#include "datasets/recording.hpp"
#include "datasets/sensor_rows.hpp"

namespace odobench::log_import {

// Cuts gyro.z and camera.x, .y, .heading of a log into its drives, with their own stamps: nothing is
// interpolated, gaps stay. Stamps by the robot's clock are those of the curves less `offsets` of their
// sources [s].
class DriveSensors {
 public:
  DriveSensors(const LogMap& map, const LogCurves& curves, const std::map<std::string, double>& offsets);

  // Those that measured between `from` and `to` [s, since LogCurves::begin_ns], which the recording begins
  // and ends at. A camera's pose (x, y, heading) with its mount (mx, my, yaw) in the robot's frame gives the
  // robot's, which is then turned and shifted as a whole so that its first one is the reference's at that
  // time (straight between its stamps): a camera's frame is its own.
  std::vector<SensorRows> of_drive(const Recording& recording, double from, double to) const;

 private:
  double shift(const Curve& curve) const;
  SensorRows gyro(double from, double to) const;
  SensorRows camera(const Recording& recording, double from, double to) const;

  const LogMap& map_;
  const LogCurves& curves_;
  const std::map<std::string, double>& offsets_;
  const Curve *gyro_ = nullptr, *x_ = nullptr, *y_ = nullptr, *heading_ = nullptr;
  std::optional<Standing> standing_;
};

}  // namespace odobench::log_import
