#include "bench/studies/fusion/fusable_recordings.hpp"

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/text.hpp"
#include "datasets/robot_4wis4wid.hpp"

namespace odobench {
namespace {

// Row j of increments is about (j - 1, j), row j of speeds about (j, j + 1).
Recording with_held_speeds(const Recording& r) {
  Recording out = recording_4wis4wid();
  out.id = r.id;
  out.trajectory = r.trajectory;
  out.repetition = r.repetition;
  out.time_us = r.time_us;
  out.reference = r.reference;
  const std::size_t n = r.size();
  for (Signal& signal : out.signals) {
    const Signal* from = r.find(signal.name);
    if (from == nullptr)
      throw DataError(
          fmt::format("recording '{}': no signal '{}', which fusion needs", shown(r.id), signal.name));
    signal.values.resize(n);
    for (std::size_t j = 0; j + 1 < n; ++j) {
      const double step = static_cast<double>(r.time_us[j + 1] - r.time_us[j]) * 1e-6;
      signal.values[j] = signal.kind == SignalKind::Angle ? from->values[j + 1] : from->values[j + 1] / step;
    }
    signal.values[n - 1] = signal.kind == SignalKind::Angle ? signal.values[n - 2] : 0;
  }
  return out;
}

}  // namespace

FusableRecordings fusable_recordings(const LoadedProblem& loaded) {
  const std::vector<Recording>& all = loaded.calibration->recordings();
  FusableRecordings out;
  if (loaded.calibration->structured() || loaded.dataset->robot.kinematics != "4wis4wid") {
    require_4wis4wid(loaded, "sensor fusion");
    out.recordings = all;
    return out;
  }
  for (const Recording& r : all) {
    if (!r.reference.sample.empty())
      throw DataError(
          fmt::format("recording '{}': a reference at {} of {} stamps, expected one at every "
                      "stamp for sensor fusion",
                      shown(r.id), r.reference.sample.size(), r.size()));
    bool speeds = true;
    for (const Signal& signal : r.signals) speeds = speeds && signal.kind != SignalKind::Increment;
    out.recordings.push_back(speeds ? r : with_held_speeds(r));
    Reference& reference = out.recordings.back().reference;
    const Eigen::Vector2d origin(reference.x.front(), reference.y.front());
    for (double& x : reference.x) x -= origin[0];
    for (double& y : reference.y) y -= origin[1];
    out.origins.push_back(origin);
  }
  return out;
}

void shift_streams(const FusableRecordings& fusable, const SensorsFile& sensors,
                   std::vector<std::vector<SensorStream>>& streams) {
  for (std::size_t i = 0; i < fusable.origins.size(); ++i)
    for (std::size_t s = 0; s < sensors.sensors.size(); ++s) {
      SensorStream& stream = streams[i][s];
      const bool position = stream.kind == SensorKind::Pose || stream.kind == SensorKind::RelativePose;
      if (sensors.sensors[s].file.empty() || !position) continue;
      for (Measurement& m : stream.data) m.value.head<2>() -= fusable.origins[i];
    }
}

}  // namespace odobench
