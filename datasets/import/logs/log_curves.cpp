#include "datasets/import/logs/log_curves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/angle.hpp"
#include "base/files.hpp"
#include "base/text.hpp"
#include "datasets/import/logs/gyro_standing.hpp"
#include "datasets/import/logs/log_groups.hpp"
#include "datasets/import/logs/log_rows.hpp"

namespace odobench::log_import {

double Curve::at(double t, std::size_t& hint) const {
  if (hint + 1 >= time.size() || time[hint] > t)
    hint = static_cast<std::size_t>(
        std::max<std::ptrdiff_t>(0, std::upper_bound(time.begin(), time.end(), t) - time.begin() - 1));
  while (hint + 2 < time.size() && time[hint + 1] <= t) ++hint;
  if (t <= time.front()) return value.front();
  if (t >= time.back()) return value.back();
  const double share = (t - time[hint]) / (time[hint + 1] - time[hint]);
  return value[hint] + share * (value[hint + 1] - value[hint]);
}

double Curve::median_step() const {
  std::vector<double> steps(time.size() > 1 ? time.size() - 1 : 0);
  for (std::size_t k = 0; k < steps.size(); ++k) steps[k] = time[k + 1] - time[k];
  if (steps.empty()) return 0;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

namespace {

// Angle of a drive at its stamps, in place of what the sensor says.
void accumulate_drive(const SignalFormat& format, Curve& curve) {
  std::vector<double>& v = curve.value;
  if (format.kind == SignalFormat::Kind::Speed) {
    for (double& speed : v) speed *= format.scale;
    double angle = 0, before = v.front();
    v.front() = 0;
    for (std::size_t k = 1; k < v.size(); ++k) {
      angle += (before + v[k]) / 2 * (curve.time[k] - curve.time[k - 1]);
      before = v[k];
      v[k] = angle;
    }
    return;
  }
  const bool first_counts = format.kind == SignalFormat::Kind::Increment;
  convert(format, v);
  if (!first_counts) v.front() = 0;
  std::partial_sum(v.begin(), v.end(), v.begin());
}

std::size_t unwrap(std::vector<double>& angle) {
  std::size_t jumps = 0;
  double turns = 0;
  for (std::size_t k = 1; k < angle.size(); ++k) {
    const double step = angle[k] + turns - angle[k - 1];
    if (std::abs(step) > kPi) {
      turns -= 2 * kPi * std::round(step / (2 * kPi));
      ++jumps;
    }
    angle[k] += turns;
  }
  return jumps;
}

class CurveReader {
 public:
  CurveReader(const LogMap& map, const LogGroup& group, const LogOptions& options, const Stop& stop)
      : map_(map), rows_(read_rows(map, group, options, stop)) {
    out_.id = group.id;
    for (const auto& [source, file] : group.file_of)
      if (std::find(out_.files.begin(), out_.files.end(), file) == out_.files.end())
        out_.files.push_back(file);
    out_.notes = rows_.notes;
  }

  LogCurves read() {
    read_reference();
    for (const MappedSignal& signal : map_.signals) {
      Curve curve = take(signal.at, signal.format.name);
      if (signal.format.signal_kind() == SignalKind::Angle) {
        for (double& v : curve.value) v = (v + signal.half_count) * signal.format.scale;
      } else {
        if (const std::optional<std::size_t> k = beyond_counter(signal.format, curve.value))
          throw DataError(fmt::format("{}: {} is {} at row {}, beyond a counter of {} bits",
                                      shown_path(rows_.file_of(signal.at.source)), signal.format.name,
                                      curve.value[*k], *k + 1, signal.format.bits));
        accumulate_drive(signal.format, curve);
      }
      out_.signals.push_back(std::move(curve));
    }
    for (const MappedField& field : map_.others)
      if (rows_.has(field)) {
        out_.others.push_back(take(field, field.target));
        for (double& v : out_.others.back().value) v *= field.scale;
      }
    if (map_.kind == ReferenceKind::Headings) turn_by_gyro();
    if (!map_.reference.empty() && map_.kind != ReferenceKind::Headings) report(out_.x);
    for (const Curve& curve : out_.signals) report(curve);
    for (const Curve& curve : out_.others) report(curve);
    return std::move(out_);
  }

 private:
  void read_reference() {
    const bool none = map_.reference.empty();
    const SourceRows& rows = rows_.of(none ? map_.signals.front().at.source : map_.reference.front().source);
    out_.begin_ns = rows.time_ns.empty() ? 0 : rows.time_ns.front();
    if (none || map_.kind == ReferenceKind::Headings) return;
    std::vector<Curve> curves;
    for (const MappedField& field : map_.reference) {
      curves.push_back(take(field, field.target));
      for (double& v : curves.back().value) v *= field.scale;
    }
    if (curves[0].time != curves[1].time || curves[0].time != curves[2].time)
      throw DataError(fmt::format("{}: rows of the reference that lack x, y or heading, expected all three",
                                  shown_path(rows_.file_of(map_.reference.front().source))));
    out_.x = std::move(curves[0]);
    out_.y = std::move(curves[1]);
    out_.heading = std::move(curves[2]);
    out_.x.name = "reference";
    if (const std::size_t jumps = unwrap(out_.heading.value))
      out_.notes.push_back(fmt::format("{}: {} jumps of the heading by a turn taken out", out_.id, jumps));
  }

  // The integral of the gyro less what it said standing, by trapezoids; nobody measured x and y.
  void turn_by_gyro() {
    const auto gyro = std::find_if(out_.others.begin(), out_.others.end(),
                                   [](const Curve& curve) { return curve.name == "gyro.z"; });
    const std::optional<Standing> standing = gyro_standing(map_, out_.signals, *gyro);
    const double bias = standing ? standing->mean : 0;
    out_.heading = *gyro;
    out_.heading.name = "reference.heading";
    double angle = 0;
    for (std::size_t k = 0; k < gyro->time.size(); ++k) {
      if (k > 0)
        angle += ((gyro->value[k - 1] + gyro->value[k]) / 2 - bias) * (gyro->time[k] - gyro->time[k - 1]);
      out_.heading.value[k] = angle;
    }
    out_.x = out_.heading;
    out_.x.name = "reference";
    out_.x.value.assign(gyro->time.size(), 0.0);
    out_.y = out_.x;
    out_.notes.push_back(
        standing ? fmt::format("{}: gyro: {:.5f} rad/s while it stood ({:.1f} s) taken off; headings are its "
                               "integral",
                               out_.id, bias, standing->seconds)
                 : fmt::format("{}: gyro: the robot never stands for half a second, so that its bias is not "
                               "known and turns every heading: stand still for some seconds before driving",
                               out_.id));
  }

  // The rows of a field that have a value.
  Curve take(const MappedField& field, const std::string& name) {
    const SourceRows& rows = rows_.of(field.source);
    const std::vector<double> values = rows_.values(field);
    Curve curve{name, field.source, {}, {}};
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (std::isnan(values[k])) continue;
      curve.time.push_back(static_cast<double>(rows.time_ns[k] - out_.begin_ns) * 1e-9);
      curve.value.push_back(values[k] + field.add);
    }
    if (rows.delay_median_s && *rows.delay_median_s < 0 && *rows.delay_median_s > -1)
      curve.delay_s = -*rows.delay_median_s;
    if (curve.time.size() < 2)
      throw DataError(fmt::format("{}: {} rows of {}, expected two at least",
                                  shown_path(rows_.file_of(field.source)), curve.time.size(), name));
    return curve;
  }

  void report(const Curve& curve) {
    double gap = 0;
    for (std::size_t k = 1; k < curve.time.size(); ++k)
      gap = std::max(gap, curve.time[k] - curve.time[k - 1]);
    const double length = curve.time.back() - curve.time.front();
    std::string line =
        fmt::format("{}: {}: {} rows, {:.1f} Hz, longest gap {:.3f} s", out_.id, curve.name,
                    curve.time.size(), static_cast<double>(curve.time.size() - 1) / length, gap);
    const SourceRows& rows = rows_.of(curve.source);
    if (rows.delay_median_s)
      line += fmt::format(", stamp minus log {:.1f} ms (99 % within {:.1f})", 1e3 * *rows.delay_median_s,
                          1e3 * rows.delay_99_s);
    out_.report.push_back(std::move(line));
  }

  const LogMap& map_;
  LogRows rows_;
  LogCurves out_;
};

}  // namespace

LogCurves read_curves(const LogMap& map, const LogGroup& group, const LogOptions& options, const Stop& stop) {
  return CurveReader(map, group, options, stop).read();
}

}  // namespace odobench::log_import
