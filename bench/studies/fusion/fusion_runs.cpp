#include "bench/studies/fusion/fusion_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/error.hpp"
#include "base/names.hpp"
#include "base/parallel.hpp"
#include "base/text.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/studies/fusion/measured_sensors.hpp"
#include "bench/studies/run_tracks.hpp"
#include "problems/kalman/consistency.hpp"
#include "solvers/options.hpp"

namespace odobench {
namespace {

const std::vector<FilterChoice>& known_filters() {
  static const std::vector<FilterChoice> list = {
      {"none", false, FilterKind::Extended, false, false},
      {"ekf", true, FilterKind::Extended, false, false},
      {"ukf", true, FilterKind::Unscented, false, false},
      {"ekf-smoothed", true, FilterKind::Extended, true, false},
      {"ukf-smoothed", true, FilterKind::Unscented, true, false},
      {"ekf-literal", true, FilterKind::Extended, false, true},
  };
  return list;
}

// What one recording gave.
struct Fused {
  TrackErrors errors;
  PoseTrack track;
  std::vector<SensorStatistics> sensors;
};

Fused fuse_one(const Recording& recording, const Vector& z, const FilterChoice& filter,
               const SensorsFile& sensors, const std::vector<SensorStream>& streams) {
  if (!filter.filtered) {
    PoseTrack track = direct::integrate(recording, z);
    return {track_errors(recording, track, {}), std::move(track), {}};
  }
  FusionOptions options = sensors.options;
  options.filter.kind = filter.kind;
  options.filter.literal_47 = filter.literal;
  options.smooth = filter.smooth;
  FusionResult result;
  try {
    result = fuse(recording, z, streams, options);
  } catch (const std::runtime_error& e) {
    throw DataError(
        fmt::format("recording '{}': --filter={}: {}", shown(recording.id), filter.name, e.what()));
  }
  if (filter.smooth)
    return {track_errors(recording, result.smoothed, result.smoothed_factors), std::move(result.smoothed),
            std::move(result.sensors)};
  return {track_errors(recording, result.track, result.factors), std::move(result.track),
          std::move(result.sensors)};
}

void require_finite(const TrackErrors& e, const FilterChoice& filter) {
  double sum = e.max.x + e.max.y + e.max.theta + e.rmse_position + e.rmse_heading;
  for (const double nees : e.nees) sum += nees;
  for (const Eigen::Vector3d& one : e.component_nees) sum += one.sum();
  if (!std::isfinite(sum))
    throw DataError(
        fmt::format("recording '{}': the track of --filter={} overflows, expected parameters, "
                    "samples and deviations of a size that a robot meets",
                    e.max.recording, filter.name));
}

// Of 95 % expected; instants of one drive are not independent.
constexpr double kMostInside = 0.8;

std::string verdict(double nees, double inside, const ConsistencyBand& band,
                    const Eigen::Vector3d& components, double recordings) {
  if (band.holds(nees))
    return inside >= kMostInside ? "consistent" : "consistent on average, not at every instant";
  const bool over = nees > band.upper;
  const ConsistencyBand one = consistency_band(1, recordings);
  std::string list;
  const char* names[] = {"x", "y", "heading"};
  for (int i : {2, 0, 1})
    if (over ? components[i] > one.upper : components[i] < one.lower)
      list += (list.empty() ? ": " : ", ") + std::string(names[i]);
  return (over ? "over-confident" : "too cautious") + list;
}

void summarise_nees(const std::vector<Fused>& fused, FusionRow& row) {
  const auto count = static_cast<double>(fused.size());
  const ConsistencyBand band = consistency_band(3, count);
  row.lower = band.lower;
  row.upper = band.upper;
  Eigen::Vector3d components = Eigen::Vector3d::Zero();
  for (std::size_t g = 0; g < TrackErrors::kGrid; ++g) {
    double mean = 0;
    for (const Fused& f : fused) {
      mean += f.errors.nees[g] / count;
      components += f.errors.component_nees[g] / count / static_cast<double>(TrackErrors::kGrid);
    }
    row.nees.push_back(mean);
    row.mean_nees += mean / static_cast<double>(TrackErrors::kGrid);
    row.inside += (band.holds(mean) ? 1.0 : 0.0) / static_cast<double>(TrackErrors::kGrid);
  }
  row.verdict = verdict(row.mean_nees, row.inside, band, components, count);
}

// The mean of so many differences of white noise that the filter believes in.
double noise_of_mean(const SensorsFile& file, std::size_t sensor, double judged) {
  const double rate = file.sensors[sensor].stream.sigma_rate;
  return std::hypot(rate, file.options.sigma_yaw_rate) / std::sqrt(std::max(1.0, judged));
}

void summarise_sensors(const std::vector<Fused>& fused, const SensorsFile& file, FusionRow& row) {
  for (std::size_t s = 0; s < fused.front().sensors.size(); ++s) {
    FusionSensorRow out;
    out.name = fused.front().sensors[s].name;
    double total = 0;
    for (const Fused& f : fused) {
      const SensorStatistics& one = f.sensors[s];
      const auto judged = static_cast<double>(one.used + one.rejected);
      out.used += static_cast<double>(one.used);
      out.rejected += static_cast<double>(one.rejected);
      out.late += static_cast<double>(one.late);
      out.dof = std::max(out.dof, one.dof);
      out.mean_nis += judged * one.mean_nis;
      total += judged;
      if (file.sensors[s].stream.kind != SensorKind::YawRate) continue;
      const double noise = noise_of_mean(file, s, judged), count = static_cast<double>(fused.size());
      out.innovation_rms += one.mean_innovation * one.mean_innovation / count;
      out.innovation_noise += noise * noise / count;
    }
    out.innovation_rms = std::sqrt(out.innovation_rms);
    out.innovation_noise = std::sqrt(out.innovation_noise);
    if (total > 0 && out.dof > 0) {
      out.mean_nis /= total;
      const ConsistencyBand band = consistency_band(out.dof, total);
      out.lower = band.lower;
      out.upper = band.upper;
    }
    row.sensors.push_back(out);
  }
}

std::string believed(const SyntheticSensor& s) {
  if (s.stream.kind == SensorKind::YawRate) return fmt::format("{:g} rad/s", s.stream.sigma_rate);
  if (s.stream.kind == SensorKind::Heading) return fmt::format("{:g} rad", s.stream.sigma_heading);
  return fmt::format("{:g} m, {:g} rad", s.stream.sigma_position, s.stream.sigma_heading);
}

std::string made_with(const SyntheticSensor& s) {
  if (!s.file.empty())
    return "measured: " + shown(s.file) + (s.standing.empty() ? "" : ", less what it said standing");
  if (s.stream.kind == SensorKind::YawRate)
    return fmt::format("bias {:g} rad/s, walk {:g} rad/s/√s, white {:g} rad/s", s.gyro.bias, s.gyro.bias_walk,
                       s.gyro.noise);
  return fmt::format("scale {:+.2g} ± {:.2g} %, walk {:g} m/√s and {:g} rad/√s, white {:g} m and {:g} rad",
                     100 * s.camera.scale_mean, 100 * s.camera.scale, s.camera.position_walk,
                     s.camera.heading_walk, s.camera.position_noise, s.camera.heading_noise);
}

}  // namespace

Table sensor_table(const SensorsFile& file, std::uint64_t seed, const std::string& dataset,
                   const std::vector<std::string>& wheels) {
  Table table;
  table.id = "sensors";
  const auto synthetic = std::count_if(file.sensors.begin(), file.sensors.end(),
                                       [](const SyntheticSensor& s) { return s.file.empty(); });
  table.title =
      synthetic == 0
          ? fmt::format("Sensors: measured, read from files ({})", file.name)
          : fmt::format("SYNTHETIC SENSORS: {} simulated from the motion capture of '{}' ({}, seed {})",
                        static_cast<std::size_t>(synthetic) == file.sensors.size()
                            ? "camera and gyro are"
                            : fmt::format("{} of {} are", synthetic, file.sensors.size()),
                        dataset, file.name, seed);
  for (const char* name :
       {"sensor", "type", "rate", "delay", "missing", "errors it is made with", "σ in the filter"}) {
    Column column;
    column.id = column.name = name;
    column.align = Align::Left;
    table.columns.push_back(column);
  }
  const char* kinds[] = {"pose", "heading", "relative pose", "yaw rate"};
  for (const SyntheticSensor& s : file.sensors)
    table.rows.push_back({text_cell(s.stream.name), text_cell(kinds[static_cast<int>(s.stream.kind)]),
                          text_cell(s.file.empty() ? fmt::format("{:g} Hz", s.timing.rate_hz) : "its own"),
                          text_cell(fmt::format("{:g} s", s.timing.delay_s)),
                          s.file.empty() ? text_cell(fmt::format("{:g} %", 100 * s.timing.missing)) : Cell{},
                          text_cell(made_with(s)), text_cell(believed(s))});
  if (!file.description.empty()) table.notes.push_back(file.description);
  table.notes.insert(table.notes.end(), wheels.begin(), wheels.end());
  return table;
}

std::vector<FilterChoice> parse_filters(const std::vector<std::string>& lists) {
  std::vector<std::string> names, wanted = comma_items(lists);
  for (const FilterChoice& f : known_filters()) names.push_back(f.name);
  if (wanted.empty()) wanted = {"none", "ekf", "ukf"};
  std::vector<FilterChoice> filters;
  for (const std::string& name : wanted) {
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end()) {
      throw std::invalid_argument(fmt::format(
          "--filter: unknown filter '{}'{}; expected none, ekf, ukf, ekf-smoothed, ukf-smoothed or "
          "ekf-literal",
          name, did_you_mean(name, names)));
    }
    const FilterChoice& choice = known_filters()[static_cast<std::size_t>(at - names.begin())];
    for (const FilterChoice& f : filters)
      if (f.name == name) throw std::invalid_argument(fmt::format("--filter: '{}' is given twice", name));
    filters.push_back(choice);
  }
  return filters;
}

FusedRow fuse_all(std::span<const Recording> recordings, const Vector& z, const FilterChoice& filter,
                  const SensorsFile& sensors, const std::vector<std::vector<SensorStream>>& streams,
                  int threads, const Stop& stop) {
  std::vector<Fused> fused(recordings.size());
  parallel_for(
      recordings.size(), thread_count(threads),
      [&](std::size_t i) {
        fused[i] = fuse_one(recordings[i], z, filter, sensors, streams[i]);
        require_finite(fused[i].errors, filter);
      },
      stop);
  FusedRow out;
  out.row.filtered = filter.filtered;
  double samples = 0, position = 0, heading = 0;
  for (std::size_t i = 0; i < fused.size(); ++i) {
    const TrackErrors& e = fused[i].errors;
    const auto n = static_cast<double>(recordings[i].size());
    samples += n;
    position += n * e.rmse_position * e.rmse_position;
    heading += n * e.rmse_heading * e.rmse_heading;
    append_track(fused[i].track, out.track);
    out.errors.push_back(
        {e.max.recording, e.max.trajectory, e.max.repetition, {e.max.x, e.max.y, e.max.theta}});
  }
  out.row.rmse_position = std::sqrt(position / samples);
  out.row.rmse_heading = std::sqrt(heading / samples);
  if (!filter.filtered) return out;
  summarise_nees(fused, out.row);
  summarise_sensors(fused, sensors, out.row);
  return out;
}

std::vector<std::vector<SensorStream>> all_streams(const SensorsFile& file,
                                                   std::span<const Recording> recordings, std::uint64_t seed,
                                                   int threads, const Stop& stop) {
  std::vector<std::vector<SensorStream>> streams(recordings.size());
  parallel_for(
      recordings.size(), thread_count(threads),
      [&](std::size_t i) {
        streams[i] = make_streams(file, recordings[i], seed);
        for (std::size_t s = 0; s < file.sensors.size(); ++s)
          if (!file.sensors[s].file.empty())
            read_measurements(file, file.sensors[s], recordings[i], streams[i][s], stop);
      },
      stop);
  return streams;
}

}  // namespace odobench
