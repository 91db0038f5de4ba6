#include "datasets/import/logs/log_drives.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "datasets/import/logs/drive_parts.hpp"
#include "datasets/import/logs/drive_sensors.hpp"

namespace odobench::log_import {
namespace {

constexpr double kDenseStep = 0.1;   // s, of a reference whose stamps are the grid
constexpr double kLeastStep = 2e-6;  // s, of stamps of different sources

class DriveMaker {
 public:
  DriveMaker(const LogMap& map, const LogCurves& curves, const Mount& mount,
             const std::map<std::string, double>& offsets)
      : map_(map), curves_(curves), mount_(mount), sensors_(map, curves, offsets) {
    reference_shift_ = shift(curves.x.source, offsets);
    for (const Curve& signal : curves.signals) shifts_.push_back(shift(signal.source, offsets));
  }

  LogDrives make() {
    LogDrives out;
    const PartFinder finder(map_, curves_, reference_shift_, shifts_);
    for (const Part& part : finder.find(out.notes)) {
      std::vector<SensorRows> sensors;
      Recording recording = record(part, &sensors);
      if (recording.size() < 2 || recording.reference.x.size() < 2) continue;
      out.recordings.push_back(std::move(recording));
      out.sensors.push_back(std::move(sensors));
      out.names.push_back(part.name);
    }
    if (out.recordings.empty())
      throw DataError(
          fmt::format("{}: no drive of {} s or more without a gap", curves_.id, map_.shortest_drive_s));
    return out;
  }

 private:
  static double shift(const std::string& source, const std::map<std::string, double>& offsets) {
    const auto found = offsets.find(source);
    return found == offsets.end() ? 0 : found->second;
  }

  // Stamps of the first wheel, where nothing else is known in between.
  std::vector<double> own_grid(const Part& part) const {
    std::vector<double> stamps;
    for (const double time : curves_.signals.front().time) {
      const double t = time - shifts_.front();
      if (t >= part.from && t <= part.to && (stamps.empty() || t - stamps.back() >= kLeastStep))
        stamps.push_back(t);
    }
    return stamps;
  }

  // Stamps of the drive, and which of them have a reference.
  std::vector<double> grid(const Part& part, std::vector<std::size_t>& sample,
                           std::vector<std::size_t>& rows) const {
    if (curves_.x.time.empty()) return own_grid(part);
    std::vector<double> stamps;
    for (std::size_t k = 0; k < curves_.x.time.size(); ++k) {
      const double t = curves_.x.time[k] - reference_shift_;
      if (t < part.from || t > part.to) continue;
      stamps.push_back(t);
      rows.push_back(k);
    }
    if (stamps.size() < 2 || curves_.x.median_step() <= kDenseStep) return stamps;
    std::vector<double> all = stamps;
    for (const double time : curves_.signals.front().time) {
      const double t = time - shifts_.front();
      // Of two stamps within a microsecond the reference's stays.
      if (t > stamps.front() && t <= stamps.back()) all.push_back(t);
    }
    std::sort(all.begin(), all.end());
    std::vector<double> kept;
    std::size_t next = 0;
    for (const double t : all) {
      const bool of_reference = next < stamps.size() && t == stamps[next];
      if (of_reference) {
        while (!kept.empty() && t - kept.back() < kLeastStep) kept.pop_back();
        sample.push_back(kept.size());
        ++next;
      } else if ((!kept.empty() && t - kept.back() < kLeastStep)) {
        continue;
      }
      kept.push_back(t);
    }
    return kept;
  }

  Recording record(const Part& part, std::vector<SensorRows>* sensors) const {
    Recording r;
    std::vector<std::size_t> rows;
    const std::vector<double> t = grid(part, r.reference.sample, rows);
    if (t.size() < 2) return r;
    for (const double stamp : t) r.time_us.push_back(std::llround((stamp - t.front()) * 1e6));
    if (std::adjacent_find(r.time_us.begin(), r.time_us.end(), std::greater_equal<>()) != r.time_us.end())
      throw DataError(fmt::format("{}: stamps of the reference less than a microsecond apart", curves_.id));
    for (std::size_t i = 0; i < curves_.signals.size(); ++i) {
      const bool steers = map_.signals[i].format.signal_kind() == SignalKind::Angle;
      Signal signal{map_.signals[i].format.name, steers ? SignalKind::Angle : SignalKind::Increment, {}};
      signal.values.resize(t.size());
      const Curve& curve = curves_.signals[i];
      std::size_t hint = 0;
      double before = curve.at(t.front() + shifts_[i], hint);
      signal.values[0] = steers ? before : 0;
      for (std::size_t j = 1; j < t.size(); ++j) {
        const double at = curve.at((steers ? (t[j - 1] + t[j]) / 2 : t[j]) + shifts_[i], hint);
        signal.values[j] = steers ? at : at - before;
        before = at;
      }
      r.signals.push_back(std::move(signal));
    }
    if (curves_.x.time.empty()) r.reference = {{0, t.size() - 1}, {0, 0}, {0, 0}, {0, 0}};
    for (const std::size_t k : rows) {
      const double theta = curves_.heading.value[k] - mount_.yaw;
      const double c = std::cos(theta), s = std::sin(theta);
      r.reference.theta.push_back(theta);
      r.reference.x.push_back(curves_.x.value[k] - c * mount_.x + s * mount_.y);
      r.reference.y.push_back(curves_.y.value[k] - s * mount_.x - c * mount_.y);
    }
    if (sensors != nullptr) *sensors = sensors_.of_drive(r, t.front(), t.back());
    return r;
  }

  const LogMap& map_;
  const LogCurves& curves_;
  Mount mount_;
  DriveSensors sensors_;
  double reference_shift_ = 0;
  std::vector<double> shifts_;  // of the signals
};

}  // namespace

LogDrives make_drives(const LogMap& map, const LogCurves& curves, const Mount& mount,
                      const std::map<std::string, double>& offsets) {
  return DriveMaker(map, curves, mount, offsets).make();
}

}  // namespace odobench::log_import
