#include "problems/calibration/models/model_signals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace odobench {

using Eigen::Index;

void read_earlier(const Vector& t, const Vector& values, double offset, Vector& out, Vector& by) {
  const Index n = t.size();
  out.resize(n);
  by.setZero(n);
  Index at = 0;
  const auto slope = [&](Index i) { return (values[i + 1] - values[i]) / (t[i + 1] - t[i]); };
  for (Index k = 0; k < n; ++k) {
    const double time = t[k] - offset;
    if (time < t[0] || time > t[n - 1]) {
      out[k] = values[time < t[0] ? 0 : n - 1];
      continue;
    }
    while (at + 2 < n && t[at + 1] <= time) ++at;
    if (time == t[at] || time == t[n - 1]) {
      const Index knot = time == t[at] ? at : n - 1;
      out[k] = values[knot];
      const double before = knot > 0 ? slope(knot - 1) : 0, behind = knot + 1 < n ? slope(knot) : 0;
      by[k] = -0.5 * (before + behind);
      continue;
    }
    by[k] = -slope(at);
    out[k] = values[at] + (time - t[at]) * slope(at);
  }
}

ModelSignals::ModelSignals(const robots::WheeledRobot& robot, const ModelTerms& terms)
    : names_(robot.signals()), drive_count_(robot.drive_count()) {
  speeds_only_ = terms.shift == ModelTerms::Shift::Speeds;
  const auto signal_index = [&](const std::string& name) {
    return static_cast<Index>(std::find(names_.begin(), names_.end(), name) - names_.begin());
  };
  const bool time = terms.free_time_offset;
  std::vector<bool> gains(robot.table().wheels.size(), false);
  for (const BoundParameter& p : robot.table().parameters)
    for (const Binding& b : p.bindings)
      if (b.field == WheelField::Gain) gains[b.wheel] = true;
  for (std::size_t i = 0; i < robot.table().wheels.size(); ++i) {
    const Wheel& wheel = robot.table().wheels[i];
    Places p;
    const auto next = [&] { return streams_++; };
    for (const DriveSignal& d : wheel.drive) p.drives.emplace_back(signal_index(d.name), d.weight);
    if (!wheel.drive.empty()) p.drive = next();
    if (!wheel.drive.empty() && time) p.drive_by = next();
    if (is_steered(wheel)) {
      p.steered_by = signal_index(wheel.steering);
      p.cosine = next();
      p.sine = next();
      if (gains[i]) p.steering = next();
      if (terms.rates()) p.change = next();
      if (time && !speeds_only_) p.steering_by = next();
      if (time && !speeds_only_ && terms.rates()) p.change_by = next();
    }
    places_.push_back(std::move(p));
  }
}

void ModelSignals::place(std::vector<kernel::ModelWheel>& wheels) const {
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const Places& p = places_[i];
    kernel::ModelWheel& w = wheels[i];
    w.drive = p.drive;
    w.cosine = p.cosine;
    w.sine = p.sine;
    w.change = p.change;
    w.steering = p.steering;
    w.drive_by = p.drive_by;
    w.steering_by = p.steering_by;
    w.change_by = p.change_by;
  }
}

ModelSignals::Raw ModelSignals::raw(const Recording& recording) const {
  Raw raw;
  const auto stamps = static_cast<Index>(recording.size());
  raw.time.resize(stamps);
  for (Index k = 0; k < stamps; ++k)
    raw.time[k] = static_cast<double>(recording.time_us[static_cast<std::size_t>(k)]) * 1e-6;
  raw.values.resize(static_cast<Index>(names_.size()), stamps);
  bool speeds = false;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const Signal* signal = recording.find(names_[i]);
    if (signal == nullptr)
      throw std::invalid_argument(
          fmt::format("recording '{}' has no signal '{}', which the robot needs", recording.id, names_[i]));
    const bool drives = static_cast<Index>(i) < drive_count_;
    if ((signal->kind == SignalKind::Angle) == drives)
      throw std::invalid_argument(fmt::format("recording '{}': signal '{}' is of kind {}, expected {}",
                                              recording.id, signal->name, name_of(signal->kind),
                                              drives ? "a speed or an increment" : "an angle"));
    speeds = speeds || signal->kind == SignalKind::Speed;
    raw.increments = raw.increments || signal->kind == SignalKind::Increment;
    raw.values.row(static_cast<Index>(i)) =
        Eigen::Map<const Eigen::RowVectorXd>(signal->values.data(), stamps);
  }
  if (speeds && raw.increments)
    throw std::invalid_argument(fmt::format(
        "recording '{}' mixes speeds and increments of its wheels, expected one of them", recording.id));
  return raw;
}

namespace {

// A signal at an offset, per interval: rad of drives, angles and changes of steering; and their derivatives.
struct Read {
  Vector value, by, change, change_by;
};

// With the intervals' lengths from whole microseconds: stamps that end at 30 s have lost digits by then.
Read read_drive(const ModelSignals::Raw& raw, Index row, double offset, const Vector& seconds) {
  Read read;
  const Index n = raw.intervals();
  Vector values = raw.values.row(row).transpose(), out, by;
  if (raw.increments) {  // of what they add up to: what is cut off before the first stamp did not move
    values[0] = 0;
    if (offset != 0) {
      for (Index k = 1; k <= n; ++k) values[k] += values[k - 1];
    } else {
      read.value = values.tail(n);
      for (Index k = 1; k <= n; ++k) values[k] += values[k - 1];
      read_earlier(raw.time, values, 0, out, by);
      read.by = by.tail(n) - by.head(n);
      return read;
    }
    read_earlier(raw.time, values, offset, out, by);
    read.value = out.tail(n) - out.head(n);
    read.by = by.tail(n) - by.head(n);
    return read;
  }
  read_earlier(raw.time, values, offset, out, by);
  read.value = out.head(n).cwiseProduct(seconds);
  read.by = by.head(n).cwiseProduct(seconds);
  return read;
}

Read read_steering(const ModelSignals::Raw& raw, Index row, double offset) {
  Read read;
  const Index n = raw.intervals();
  Vector out, by;
  read_earlier(raw.time, raw.values.row(row).transpose(), offset, out, by);
  read.value = raw.increments ? out.tail(n) : out.head(n);
  read.by = raw.increments ? by.tail(n) : by.head(n);
  read.change = out.tail(n) - out.head(n);
  read.change_by = by.tail(n) - by.head(n);
  return read;
}

}  // namespace

std::vector<double> ModelSignals::blocks(const Raw& raw, double time_offset, const std::vector<double>& gains,
                                         Index steps, int width) const {
  const Index n = raw.intervals();
  std::vector<double> data(static_cast<std::size_t>(steps * streams_ * width), 0.0);
  // `rest`: behind the last interval.
  const auto put = [&](int stream, const Vector& values, double rest) {
    if (stream < 0) return;
    for (Index lane = 0, k = 0; lane < width; ++lane)
      for (Index s = 0; s < steps; ++s, ++k)
        data[static_cast<std::size_t>((s * streams_ + stream) * width + lane)] = k < n ? values[k] : rest;
  };
  Vector seconds(n);
  for (Index k = 0; k < n; ++k)
    seconds[k] = (std::round(raw.time[k + 1] * 1e6) - std::round(raw.time[k] * 1e6)) * 1e-6;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const Places& p = places_[i];
    if (!p.drives.empty()) {
      Vector value = Vector::Zero(n), by = Vector::Zero(n);
      for (const auto& [signal, weight] : p.drives) {
        const Read read = read_drive(raw, signal, time_offset, seconds);
        value += weight * read.value;
        by += weight * read.by;
      }
      put(p.drive, value, 0);
      put(p.drive_by, by, 0);
    }
    if (p.steered_by < 0) continue;
    const Read read = read_steering(raw, p.steered_by, speeds_only_ ? 0 : time_offset);
    const Vector angle = gains[i] * read.value;
    put(p.cosine, angle.array().cos(), 1);
    put(p.sine, angle.array().sin(), 0);
    put(p.steering, read.value, 0);
    put(p.change, read.change, 0);
    put(p.steering_by, read.by, 0);
    put(p.change_by, read.change_by, 0);
  }
  return data;
}

}  // namespace odobench
