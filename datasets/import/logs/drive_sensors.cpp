#include "datasets/import/logs/drive_sensors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "base/error.hpp"
#include "datasets/import/logs/gyro_standing.hpp"

namespace odobench::log_import {
namespace {

const Curve* curve_called(const LogCurves& curves, const char* name) {
  for (const Curve& curve : curves.others)
    if (curve.name == name) return &curve;
  return nullptr;
}

struct PlanePose {
  double x = 0, y = 0, heading = 0;
};

// The reference at t [us], straight between its stamps.
PlanePose reference_at(const Recording& r, double t) {
  const Reference& ref = r.reference;
  const auto stamp = [&](std::size_t k) {
    return static_cast<double>(r.time_us[ref.sample.empty() ? k : ref.sample[k]]);
  };
  std::size_t k = 0;
  while (k + 2 < ref.x.size() && stamp(k + 1) <= t) ++k;
  const double share = std::clamp((t - stamp(k)) / (stamp(k + 1) - stamp(k)), 0.0, 1.0);
  const auto at = [&](const std::vector<double>& v) { return v[k] + share * (v[k + 1] - v[k]); };
  return {at(ref.x), at(ref.y), at(ref.theta)};
}

}  // namespace

DriveSensors::DriveSensors(const LogMap& map, const LogCurves& curves,
                           const std::map<std::string, double>& offsets)
    : map_(map), curves_(curves), offsets_(offsets) {
  gyro_ = curve_called(curves, "gyro.z");
  x_ = curve_called(curves, "camera.x");
  y_ = curve_called(curves, "camera.y");
  heading_ = curve_called(curves, "camera.heading");
  if (x_ != nullptr || y_ != nullptr || heading_ != nullptr) {
    for (const Curve* curve : {x_, y_, heading_})
      if (curve == nullptr || curve->time != (x_ != nullptr ? x_ : curve)->time)
        throw DataError(fmt::format(
            "{}: rows of the camera that lack camera.x, camera.y or camera.heading, expected all three",
            curves.id));
  }
  if (gyro_ != nullptr) standing_ = gyro_standing(map, curves.signals, *gyro_, offsets);
}

double DriveSensors::shift(const Curve& curve) const {
  const auto found = offsets_.find(curve.source);
  return found == offsets_.end() ? 0 : found->second;
}

SensorRows DriveSensors::gyro(double from, double to) const {
  SensorRows rows{"gyro", {"yaw_rate"}, {}, {{}}, gyro_->delay_s, standing_};
  for (std::size_t k = 0; k < gyro_->time.size(); ++k) {
    const double t = gyro_->time[k] - shift(*gyro_);
    if (t < from || t > to) continue;
    rows.time_us.push_back(std::llround((t - from) * 1e6));
    rows.values[0].push_back(gyro_->value[k]);
  }
  return rows;
}

SensorRows DriveSensors::camera(const Recording& recording, double from, double to) const {
  SensorRows rows{"camera", {"x", "y", "heading"}, {}, {{}, {}, {}}, x_->delay_s, {}};
  PlanePose first, target;
  for (std::size_t k = 0; k < x_->time.size(); ++k) {
    const double t = x_->time[k] - shift(*x_);
    if (t < from || t > to) continue;
    PlanePose p{0, 0, heading_->value[k] - map_.camera_yaw};
    p.x = x_->value[k] - std::cos(p.heading) * map_.camera_x + std::sin(p.heading) * map_.camera_y;
    p.y = y_->value[k] - std::sin(p.heading) * map_.camera_x - std::cos(p.heading) * map_.camera_y;
    if (rows.time_us.empty()) {
      first = target = p;
      if (recording.reference.x.size() > 1 && !map_.reference.empty())
        target = reference_at(recording, (t - from) * 1e6);
    }
    const double turn = target.heading - first.heading, c = std::cos(turn), s = std::sin(turn);
    rows.time_us.push_back(std::llround((t - from) * 1e6));
    rows.values[0].push_back(target.x + c * (p.x - first.x) - s * (p.y - first.y));
    rows.values[1].push_back(target.y + s * (p.x - first.x) + c * (p.y - first.y));
    rows.values[2].push_back(wrapped_angle(p.heading + turn));
  }
  return rows;
}

std::vector<SensorRows> DriveSensors::of_drive(const Recording& recording, double from, double to) const {
  std::vector<SensorRows> all;
  if (gyro_ != nullptr) all.push_back(gyro(from, to));
  if (x_ != nullptr) all.push_back(camera(recording, from, to));
  for (SensorRows& rows : all) {  // stamps that share a microsecond after rounding
    std::size_t kept = 0;
    for (std::size_t k = 0; k < rows.time_us.size(); ++k) {
      if (kept > 0 && rows.time_us[k] <= rows.time_us[kept - 1]) continue;
      rows.time_us[kept] = rows.time_us[k];
      for (std::vector<double>& column : rows.values) column[kept] = column[k];
      ++kept;
    }
    rows.time_us.resize(kept);
    for (std::vector<double>& column : rows.values) column.resize(kept);
  }
  std::erase_if(all, [](const SensorRows& rows) { return rows.time_us.size() < 2; });
  return all;
}

}  // namespace odobench::log_import
