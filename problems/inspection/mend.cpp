#include "problems/inspection/mend.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "base/angle.hpp"
#include "problems/inspection/recording_checks.hpp"
#include "problems/inspection/set_checks.hpp"

namespace odobench::inspection {
namespace {

using Values = std::vector<double>;

void scale(Values& v, double factor) {
  for (double& one : v) one *= factor;
}

Signal* signal_called(Recording& r, const std::string& name) {
  for (Signal& s : r.signals)
    if (s.name == name) return &s;
  return nullptr;
}

void scale_signal(Recording& r, const std::string& name, double factor) {
  if (Signal* s = signal_called(r, name)) scale(s->values, factor);
}

// Every drive signal, or every steering signal, once.
std::vector<std::string> signal_names(const Robot& robot, bool drives) {
  std::vector<std::string> names;
  for (const Wheel& w : robot.table.wheels) {
    std::vector<std::string> own;
    if (!drives && !w.steering.empty()) own.push_back(w.steering);
    if (drives)
      for (const DriveSignal& d : w.drive) own.push_back(d.name);
    for (const std::string& name : own)
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

// What columns of the wheels hold other wheels: the values go where they belong.
void reorder(const Robot& robot, const Finding& f, Recording& r) {
  const Recording before = r;
  const auto move = [&](const std::string& from, const std::string& to) {
    const Signal* source = before.find(from);
    Signal* target = signal_called(r, to);
    if (source != nullptr && target != nullptr) target->values = source->values;
  };
  for (std::size_t i = 0; i < robot.table.wheels.size(); ++i) {
    const auto held = f.figures.find(fmt::format("column_{}", i + 1));
    if (held == f.figures.end()) continue;
    const Wheel &column = robot.table.wheels[i],
                &wheel = robot.table.wheels[static_cast<std::size_t>(held->second) - 1];
    move(column.drive.front().name, wheel.drive.front().name);
    if (!column.steering.empty()) move(column.steering, wheel.steering);
  }
}

void scale_radii(Robot& robot, double factor) {
  for (Wheel& w : robot.table.wheels) w.radius *= factor;
  for (BoundParameter& bound : robot.table.parameters) {
    const bool radius = std::any_of(bound.bindings.begin(), bound.bindings.end(),
                                    [](const Binding& b) { return b.field == WheelField::Radius; });
    if (!radius) continue;
    for (RobotParameter* p :
         {&bound.parameter,
          &*std::find_if(robot.parameters.begin(), robot.parameters.end(),
                         [&](const RobotParameter& one) { return one.name == bound.parameter.name; })}) {
      p->nominal *= factor;
      p->lower *= factor;
      p->upper *= factor;
    }
  }
}

Vector seconds_of(const Recording& r) {
  Vector t(static_cast<Index>(r.size()));
  for (std::size_t k = 0; k < r.size(); ++k)
    t[static_cast<Index>(k)] = 1e-6 * static_cast<double>(r.time_us[k] - r.time_us[0]);
  return t;
}

void replace_outliers(Recording& r) {
  struct Coordinate {
    Values* values;
    double floor;
  };
  for (const Coordinate& one :
       {Coordinate{&r.reference.x, 0.02}, {&r.reference.y, 0.02}, {&r.reference.theta, 0.1}}) {
    const Vector v = Eigen::Map<const Vector>(one.values->data(), static_cast<Index>(one.values->size()));
    for (const Index k : pose_outliers(v, one.floor))
      (*one.values)[static_cast<std::size_t>(k)] = median_of_seven(v, k);
  }
}

void replace_spikes(Recording& r, const std::string& name) {
  Signal* signal = signal_called(r, name);
  if (signal == nullptr) return;
  const Index n = static_cast<Index>(r.size()), shift = signal->kind == SignalKind::Increment ? 1 : 0;
  const Vector t = seconds_of(r), seconds = t.tail(n - 1) - t.head(n - 1);
  Vector speeds = Eigen::Map<const Vector>(signal->values.data() + shift, n - 1);
  if (shift == 1) speeds.array() /= seconds.array();
  double usual = 0;
  for (const Index k : spikes(speeds.cwiseAbs(), usual))
    signal->values[static_cast<std::size_t>(k + shift)] =
        median_of_seven(speeds, k) * (shift == 1 ? seconds[k] : 1);
}

void unwrap(Values& theta) {
  double turns = 0;
  for (std::size_t k = 1; k < theta.size(); ++k) {
    const double step = theta[k] + turns - theta[k - 1];
    if (std::abs(step) > 5.5 && std::abs(step) < 7) turns -= std::round(step / (2 * kPi)) * 2 * kPi;
    theta[k] += turns;
  }
}

void take_out_gap(Recording& r, std::size_t sample, double usual) {
  const std::int64_t gap = r.time_us[sample + 1] - r.time_us[sample],
                     excess = gap - std::llround(1e6 * usual);
  for (std::size_t k = sample + 1; k < r.size(); ++k) r.time_us[k] -= excess;
}

// Samples first ... first + count - 1 of everything; stamps from 0.
void cut(Recording& r, std::size_t first, std::size_t count) {
  const auto keep = [&](auto& v) {
    v.erase(v.begin() + static_cast<std::ptrdiff_t>(first + count), v.end());
    v.erase(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(first));
  };
  keep(r.time_us);
  const std::int64_t start = r.time_us.front();
  for (std::int64_t& t : r.time_us) t -= start;
  for (Signal& s : r.signals) keep(s.values);
  for (Values* v : {&r.reference.x, &r.reference.y, &r.reference.theta}) keep(*v);
}

// Moved so that the first pose has position (0, 0).
void to_origin(Recording& r) {
  const double x = r.reference.x.front(), y = r.reference.y.front();
  for (double& v : r.reference.x) v -= x;
  for (double& v : r.reference.y) v -= y;
}

void shift_reference(Recording& r, double lag, bool from_origin) {
  const Vector t = seconds_of(r);
  for (Values* v : {&r.reference.x, &r.reference.y, &r.reference.theta}) {
    const Vector moved = shifted(t, Eigen::Map<const Vector>(v->data(), t.size()), lag);
    std::copy(moved.begin(), moved.end(), v->begin());
  }
  const Index n = t.size();
  Index first = 0, last = n - 1;
  while (first < n - 2 && t[first] + lag < t[0]) ++first;
  while (last > first + 1 && t[last] + lag > t[n - 1]) --last;
  cut(r, static_cast<std::size_t>(first), static_cast<std::size_t>(last - first + 1));
  if (from_origin && first > 0) to_origin(r);
}

double figure(const Finding& f, const char* name) {
  const auto found = f.figures.find(name);
  return found == f.figures.end() ? 0 : found->second;
}

// The mirrors of hypotheses.cpp.
void unmirror(Reference& reference, int which) {
  if (which == 2) return reference.x.swap(reference.y);
  scale(reference.y, -1);
  if (which == 3) scale(reference.theta, -1);
}

void for_signals(Dataset& set, bool drives, double factor) {
  for (const std::string& name : signal_names(set.robot, drives))
    for (Recording& r : set.recordings) scale_signal(r, name, factor);
}

// Of one recording; false where the kind is of the whole set.
bool mend_recording(const Finding& f, Recording& r) {
  if (f.kind == "heading_wrapped")
    unwrap(r.reference.theta);
  else if (f.kind == "pose_outlier")
    replace_outliers(r);
  else if (f.kind == "wheel_spike" || f.kind == "encoder_overflow")
    replace_spikes(r, f.signal);
  else if (f.kind == "clock_jump")
    take_out_gap(r, *f.sample, figure(f, "usual"));
  else
    return false;
  return true;
}

void mend_factor(Dataset& set, double unit_factor) {
  if (unit_factor == 2 || unit_factor == 0.5)
    scale_radii(set.robot, 1 / unit_factor);
  else
    for_signals(set, true, 1 / unit_factor);
}

void mend_set(Dataset& set, const Finding& f) {
  const bool from_origin = set.robot.kinematics == "4wis4wid";
  if (f.kind == "common_factor") return mend_factor(set, figure(f, "unit_factor"));
  if (f.kind == "steering_degrees") return for_signals(set, false, kDegree);
  if (f.kind == "direction_reversed") return for_signals(set, true, -1);
  const Wheel* wheel = f.wheel > 0 ? &set.robot.table.wheels[f.wheel - 1] : nullptr;
  for (Recording& r : set.recordings) {
    if (f.kind == "heading_degrees") scale(r.reference.theta, kDegree);
    if (f.kind == "heading_sign") scale(r.reference.theta, -1);
    if (f.kind == "heading_turned")
      for (double& v : r.reference.theta) v -= figure(f, "angle");
    if (f.kind == "position_unit") {
      scale(r.reference.x, 1 / figure(f, "factor"));
      scale(r.reference.y, 1 / figure(f, "factor"));
    }
    if (f.kind == "frame_mirrored") unmirror(r.reference, static_cast<int>(figure(f, "mirror")));
    if (f.kind == "wheel_order") reorder(set.robot, f, r);
    if (f.kind == "steering_sign") scale_signal(r, wheel->steering, -1);
    if (f.kind == "wheel_reversed")
      for (const DriveSignal& d : wheel->drive) scale_signal(r, d.name, -1);
    if (f.kind == "start_offset" && !r.reference.x.empty()) to_origin(r);
    if (f.kind == "time_unit")
      for (std::int64_t& t : r.time_us) t *= 1000;
    if (f.kind == "reference_lag" && r.reference.sample.empty())
      shift_reference(r, figure(f, "lag"), from_origin);
  }
}

}  // namespace

std::vector<std::string> mend(Dataset& set, const std::vector<Finding>& findings) {
  std::vector<std::string> changes;
  for (const Finding& f : findings) {
    if (!f.mendable) continue;
    bool done = false;
    for (Recording& r : set.recordings)
      if (!f.recording.empty() && r.id == f.recording) done = mend_recording(f, r) || done;
    if (!done && f.recording.empty()) mend_set(set, f);
    changes.push_back(fmt::format("{}: {}", f.message, f.fix()));
    set.notes.push_back(fmt::format("mended: {}: {}", f.kind, changes.back()));
  }
  return changes;
}

}  // namespace odobench::inspection
