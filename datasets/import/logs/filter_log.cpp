#include "datasets/import/logs/filter_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "base/angle.hpp"
#include "base/error.hpp"
#include "base/range.hpp"

namespace odobench::log_import {
namespace {

constexpr double kUsualRows = 3;    // a gap is longer, where a channel is slow
constexpr double kMostFilled = 11;  // periods from row to row
constexpr double kCorner = 0.05;    // of the distance of a wheel, off the corner of the rectangle
constexpr double kLongest = 2e7;    // rows

// The integral of a curve from its first stamp on.
class Integral {
 public:
  explicit Integral(const Curve& curve) : curve_(curve) {
    sum_.push_back(0);
    for (std::size_t k = 1; k < curve.time.size(); ++k)
      sum_.push_back(sum_.back() +
                     0.5 * (curve.value[k] + curve.value[k - 1]) * (curve.time[k] - curve.time[k - 1]));
  }
  // Over (from, to), both within the stamps; `from` never goes back by more than a step.
  double over(double from, double to) {
    const double begin = until(from);
    return until(to) - begin;
  }

 private:
  double until(double t) {
    const auto next = std::upper_bound(curve_.time.begin(), curve_.time.end(), t);
    const auto k = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(
        next - curve_.time.begin() - 1, 0, static_cast<std::ptrdiff_t>(curve_.time.size()) - 2));
    const double h = t - curve_.time[k], span = curve_.time[k + 1] - curve_.time[k];
    const double slope = (curve_.value[k + 1] - curve_.value[k]) / span;
    return sum_[k] + h * (curve_.value[k] + 0.5 * slope * h);
  }
  const Curve& curve_;
  std::vector<double> sum_;
};

// Of a filter's wheel: which of the robot's signals are its drive and its steering.
struct CornerWheel {
  std::size_t drive = 0;
  std::optional<std::size_t> steering;
  double way = 0;  // m of a radian of the signal
  double mount = 0, zero = 0, gain = 1;
};

class FilterLogMaker {
 public:
  FilterLogMaker(const LogMap& map, const LogCurves& curves, const FilterLogOptions& options)
      : map_(map), options_(options) {
    out_.id = curves.id;
    for (const Curve& curve : curves.signals) channels_.push_back(by_robots_clock(curve));
    find_wheels();
    gyro_ = other(curves, "gyro.z");
    ax_ = other(curves, "accel.x");
    ay_ = other(curves, "accel.y");
    out_.notes = curves.report;
    out_.notes.insert(out_.notes.end(), curves.notes.begin(), curves.notes.end());
  }

  FilterLog make() {
    find_grid();
    find_gaps();
    fill();
    return std::move(out_);
  }

 private:
  Curve by_robots_clock(Curve curve) const {
    const MappedSource& source = source_of(map_, curve.source);
    if (!source.offset_s)
      throw std::invalid_argument(
          fmt::format("{}: /sources/{}/offset_s: found \"estimate\", expected a number: a filter has nothing "
                      "to estimate a clock by",
                      map_.file, source.name));
    return curve;  // its stamps are less what the map says
  }

  std::size_t other(const LogCurves& curves, const std::string& target) {
    const bool mapped = std::any_of(map_.others.begin(), map_.others.end(),
                                    [&](const MappedField& f) { return f.target == target; });
    if (!mapped)
      throw std::invalid_argument(
          fmt::format("{}: /signals: found no \"{}\", expected gyro.z, accel.x and accel.y beside the wheels",
                      map_.file, target));
    for (const Curve& curve : curves.others)
      if (curve.name == target) {
        channels_.push_back(by_robots_clock(curve));
        return channels_.size() - 1;
      }
    throw DataError(fmt::format("{}: no {} in this log, which {} maps", curves.id, target, map_.file));
  }

  std::size_t signal(const std::string& name) const {
    for (std::size_t i = 0; i < channels_.size(); ++i)
      if (channels_[i].name == name) return i;
    throw std::invalid_argument(fmt::format("{}: the robot has no signal \"{}\"", map_.file, name));
  }

  // In the filter's order: front right, rear right, rear left, front left.
  void find_wheels() {
    std::vector<double> nominal;
    for (const BoundParameter& p : map_.robot.table.parameters) nominal.push_back(p.parameter.nominal);
    const std::vector<Wheel> wheels = wheels_with(map_.robot.table, nominal);
    const auto refuse = [&](const std::string& found) {
      throw std::invalid_argument(
          fmt::format("{}: /robot: found {}, expected four wheels that roll without sliding, one in each "
                      "corner of a rectangle round the origin: that is the filter's robot",
                      map_.file, found));
    };
    if (wheels.size() != 4) refuse(fmt::format("{} wheels", wheels.size()));
    std::array<bool, 4> taken{};
    double length = 0, width = 0;
    for (const Wheel& w : wheels) {
      const std::size_t corner = w.x > 0 ? (w.y < 0 ? 0 : 3) : (w.y < 0 ? 1 : 2);
      if (w.x == 0 || w.y == 0 || taken[corner]) refuse(fmt::format("a wheel at ({:g}, {:g})", w.x, w.y));
      if (w.slides || w.roller != 0 || w.drive.size() != 1)
        refuse(fmt::format("the wheel at ({:g}, {:g}) {}", w.x, w.y,
                           w.drive.size() == 1 ? "that slides" : "without an encoder of its own"));
      taken[corner] = true;
      CornerWheel& c = wheel_[corner];
      c.drive = signal(w.drive.front().name);
      c.way = w.radius * w.drive.front().weight;
      if (!w.steering.empty()) c.steering = signal(w.steering);
      c.mount = w.mount;
      c.zero = w.zero;
      c.gain = w.gain;
      length += std::abs(w.x) / 2;
      width += std::abs(w.y) / 2;
    }
    out_.length = length;
    out_.width = width;
    out_.wheel_distance = std::hypot(length, width) / 2;
    for (const Wheel& w : wheels)
      if (std::hypot(std::abs(w.x) - length / 2, std::abs(w.y) - width / 2) > kCorner * out_.wheel_distance)
        refuse(fmt::format("a wheel at ({:g}, {:g}) and a mean rectangle of {:g} m x {:g} m", w.x, w.y,
                           length, width));
  }

  void find_grid() {
    double from = -kInfinity, to = kInfinity, step = 0;
    for (const Curve& c : channels_) {
      from = std::max(from, c.time.front());
      to = std::min(to, c.time.back());
    }
    for (const CornerWheel& w : wheel_) step = std::max(step, channels_[w.drive].median_step());
    if (!(from < to))
      throw DataError(fmt::format("{}: wheels, gyro and accelerometer share no time", out_.id));
    out_.dt = options_.dt.value_or(std::max(1e-6, std::round(1e6 * step) * 1e-6));
    const std::vector<double>& stamps = channels_[wheel_[0].drive].time;
    begin_ = *std::lower_bound(stamps.begin(), stamps.end(), from);
    const double count = std::floor((to - begin_) / out_.dt + 1e-6);
    if (!(count >= 1) || count > kLongest)
      throw DataError(
          fmt::format("{}: {:.3g} s that all channels share are {:.3g} rows of {:g} s, expected 1 "
                      "to {:g}",
                      out_.id, to - begin_, std::max(0.0, count), out_.dt, kLongest));
    rows_ = static_cast<std::int64_t>(count);
  }

  void find_gaps() {
    const double end = begin_ + static_cast<double>(rows_) * out_.dt;
    const double dt = out_.dt;
    for (const Curve& c : channels_) {
      const double most = std::max(map_.wheel_gap_s, kUsualRows * c.median_step());
      for (std::size_t k = 1; k < c.time.size(); ++k) {
        const double from = c.time[k - 1], to = c.time[k];
        if (to - from <= most || to <= begin_ || from >= end) continue;
        if (!options_.resample || to - from > kMostFilled * dt)
          throw DataError(
              fmt::format("{}: found no {} from {:.3f} to {:.3f} s, expected one within {:g} s; "
                          "limits/max_wheel_gap_s of "
                          "the map states it, --resample bridges up to ten rows of {:g} s",
                          out_.id, c.name, from, to, most, dt));
        gaps_.push_back({from, to});
      }
    }
  }

  void fill() {
    Integral turned(channels_[gyro_]), sum_x(channels_[ax_]), sum_y(channels_[ay_]);
    std::array<std::size_t, 4> drive_hint{}, steering_hint{};
    std::array<double, 4> angle{};
    for (std::size_t w = 0; w < 4; ++w) angle[w] = channels_[wheel_[w].drive].at(begin_, drive_hint[w]);
    std::array<std::size_t, 2> acceleration_hint{};
    const double dt = out_.dt;
    const bool often = 2 * std::max(channels_[ax_].median_step(), channels_[ay_].median_step()) <= dt;
    const auto acceleration = [&](std::size_t channel, Integral& sum, double t, std::size_t& hint) {
      const Curve& c = channels_[channel];
      const double from = std::max(c.time.front(), t - dt / 2), to = std::min(c.time.back(), t + dt / 2);
      return often && to > from ? sum.over(from, to) / (to - from) : c.at(t, hint);
    };
    out_.rows.reserve(static_cast<std::size_t>(rows_));
    for (std::int64_t k = 1; k <= rows_; ++k) {
      FilterRow row;
      const double before = begin_ + static_cast<double>(k - 1) * dt,
                   t = begin_ + static_cast<double>(k) * dt;
      row.time_s = t;
      row.line = static_cast<std::size_t>(k);
      for (std::size_t w = 0; w < 4; ++w) {
        const CornerWheel& wheel = wheel_[w];
        const double now = channels_[wheel.drive].at(t, drive_hint[w]);
        row.wheel[w] = wheel.way * (now - angle[w]);
        angle[w] = now;
        row.steering[w] = wheel.mount;
        if (wheel.steering)
          row.steering[w] +=
              wheel.zero + wheel.gain * channels_[*wheel.steering].at((before + t) / 2, steering_hint[w]);
      }
      row.rotation_deg = turned.over(before, t) / kDegree;
      row.ax = acceleration(ax_, sum_x, t, acceleration_hint[0]);
      row.ay = acceleration(ay_, sum_y, t, acceleration_hint[1]);
      out_.filled += std::any_of(gaps_.begin(), gaps_.end(),
                                 [&](const auto& gap) { return t > gap.first && t < gap.second; });
      out_.rows.push_back(row);
    }
  }

  const LogMap& map_;
  const FilterLogOptions options_;
  FilterLog out_;
  std::vector<Curve> channels_;
  std::array<CornerWheel, 4> wheel_;
  std::size_t gyro_ = 0, ax_ = 0, ay_ = 0;
  double begin_ = 0;
  std::int64_t rows_ = 0;
  std::vector<std::pair<double, double>> gaps_;
};

}  // namespace

FilterLog filter_log(const LogMap& map, const LogCurves& curves, const FilterLogOptions& options) {
  return FilterLogMaker(map, curves, options).make();
}

}  // namespace odobench::log_import
