#include "bench/studies/fusion/measured_sensors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/angle.hpp"
#include "base/error.hpp"
#include "base/files.hpp"
#include "datasets/logs/formats.hpp"

namespace odobench {
namespace {
namespace fs = std::filesystem;

fs::path file_of(const SensorsFile& file, const SyntheticSensor& sensor, const Recording& recording) {
  std::string name = sensor.file;
  const std::string mark = "{recording}";
  name.replace(name.find(mark), mark.size(), recording.id);
  return file.folder / name;
}

LogTable read_table(const fs::path& path, const SyntheticSensor& sensor, const std::vector<std::string>& what,
                    const Stop& stop) {
  const std::unique_ptr<LogFile> log = open_log(path);
  const std::vector<LogSource> sources = log->sources(stop);
  if (sources.size() != 1)
    throw DataError(fmt::format("{}: {} sources, expected one table", shown_path(path), sources.size()));
  LogRequest request;
  request.source = sources.front().name;
  request.time = sensor.columns.at("time");
  for (const std::string& column : what) request.fields.push_back(sensor.columns.at(column));
  try {
    return log->read({request}, stop).front();
  } catch (const std::invalid_argument& error) {
    throw DataError(fmt::format("{}: {}", shown_path(path), error.what()));
  }
}

double median_step(const std::vector<Measurement>& data) {
  std::vector<std::int64_t> steps;
  for (std::size_t k = 1; k < data.size(); ++k) steps.push_back(data[k].time_us - data[k - 1].time_us);
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return static_cast<double>(*middle) * 1e-6;
}

}  // namespace

void read_measurements(const SensorsFile& file, const SyntheticSensor& sensor, const Recording& recording,
                       SensorStream& stream, const Stop& stop) {
  const fs::path path = file_of(file, sensor, recording);
  const bool gyro = stream.kind == SensorKind::YawRate, heading = stream.kind == SensorKind::Heading;
  const std::vector<std::string> what = gyro      ? std::vector<std::string>{"yaw_rate"}
                                        : heading ? std::vector<std::string>{"heading"}
                                                  : std::vector<std::string>{"x", "y", "heading"};
  const LogTable table = read_table(path, sensor, what, stop);
  const auto delay = static_cast<std::int64_t>(std::llround(sensor.timing.delay_s * 1e6));
  const auto standing = sensor.standing.find(recording.id);
  const double bias = standing == sensor.standing.end() ? 0 : standing->second;
  for (std::size_t k = 0; k < table.time_ns.size(); ++k) {
    bool whole = true;
    for (const std::vector<double>& column : table.values) whole = whole && std::isfinite(column[k]);
    if (!whole) continue;
    Measurement m;
    m.time_us = std::llround(static_cast<double>(table.time_ns[k]) * 1e-3);
    m.arrival_us = m.time_us + delay;
    if (gyro)
      m.value[0] = table.values[0][k] * sensor.rate_scale - bias;
    else if (heading)
      m.value[2] = wrapped_angle(table.values[0][k] * sensor.heading_scale);
    else
      m.value = {table.values[0][k], table.values[1][k],
                 wrapped_angle(table.values[2][k] * sensor.heading_scale)};
    if (!stream.data.empty() && m.time_us <= stream.data.back().time_us)
      throw DataError(fmt::format("{}: row {}: a stamp of {:.6f} s after {:.6f} s, expected later ones",
                                  shown_path(path), k + 1, static_cast<double>(m.time_us) * 1e-6,
                                  static_cast<double>(stream.data.back().time_us) * 1e-6));
    stream.data.push_back(m);
  }
  if (stream.data.size() < 2)
    throw DataError(
        fmt::format("{}: {} measurements, expected two at least", shown_path(path), stream.data.size()));
  if (gyro) stream.hold_s = median_step(stream.data);
}

}  // namespace odobench
