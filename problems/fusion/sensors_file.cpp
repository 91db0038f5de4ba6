#include "problems/fusion/sensors_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <initializer_list>
#include <stdexcept>

#include "base/angle.hpp"
#include "base/json_node.hpp"
#include "base/random.hpp"

namespace odobench {
namespace {

// What no sensor of a robot has is a typing error. Zero and signs are judged where the value is used.
struct Limits {
  double least, most;
  const char* unit;
};
constexpr Limits kRate{1e-9, 1e5, " Hz"}, kTime{1e-9, 3600, " s"}, kSigma{1e-9, 1e6, ""},
    kShare{1e-12, 1, ""}, kError{1e-15, 1e6, ""}, kScatter{1e-6, 1e3, ""};

double number(const JsonNode& node, const Limits& limits) {
  const double value = node.number();
  if (std::abs(value) > limits.most || (value != 0 && std::abs(value) < limits.least))
    node.fail(fmt::format("{}", value),
              fmt::format("0 or {:g} up to {:g}{}", limits.least, limits.most, limits.unit));
  return value;
}

double number_or(const JsonNode& node, const std::string& key, const Limits& limits, double otherwise) {
  return node.has(key) ? number(node.at(key), limits) : otherwise;
}

SensorKind read_kind(const JsonNode& node) {
  const std::string type = node.text();
  if (type == "pose") return SensorKind::Pose;
  if (type == "heading") return SensorKind::Heading;
  if (type == "relative_pose") return SensorKind::RelativePose;
  if (type == "yaw_rate") return SensorKind::YawRate;
  node.fail(fmt::format("the unknown sensor type \"{}\"", type), "pose, heading, relative_pose or yaw_rate");
}

void read_gyro(const JsonNode& node, SyntheticSensor& s) {
  const JsonNode errors = node.at("errors"), filter = node.at("filter");
  errors.allow_only({"bias", "bias_walk", "noise"});
  filter.allow_only({"sigma_yaw_rate"});
  s.gyro = {number_or(errors, "bias", kError, 0), number_or(errors, "bias_walk", kError, 0),
            number_or(errors, "noise", kError, 0)};
  s.stream.sigma_rate = number(filter.at("sigma_yaw_rate"), kSigma);
}

void read_camera(const JsonNode& node, SyntheticSensor& s) {
  const JsonNode errors = node.at("errors"), filter = node.at("filter");
  errors.allow_only(
      {"scale", "scale_mean", "position_walk", "heading_walk", "position_noise", "heading_noise"});
  s.camera = {number_or(errors, "scale", kError, 0),          number_or(errors, "scale_mean", kError, 0),
              number_or(errors, "position_walk", kError, 0),  number_or(errors, "heading_walk", kError, 0),
              number_or(errors, "position_noise", kError, 0), number_or(errors, "heading_noise", kError, 0)};
  s.stream.sigma_heading = number(filter.at("sigma_heading"), kSigma);
  if (s.stream.kind == SensorKind::Heading) {
    filter.allow_only({"sigma_heading"});
    return;
  }
  filter.allow_only({"sigma_position", "sigma_heading"});
  s.stream.sigma_position = number(filter.at("sigma_position"), kSigma);
}

// What measurements of a file are: columns and units, and what the filter believes.
void read_measured(const JsonNode& node, SyntheticSensor& s) {
  s.file = node.at("file").text();
  if (s.file.find("{recording}") == std::string::npos)
    node.at("file").fail("a name without {recording}", "a file per recording: \"gyro_{recording}.csv\"");
  const bool gyro = s.stream.kind == SensorKind::YawRate, heading = s.stream.kind == SensorKind::Heading;
  for (const char* what : {"time", "yaw_rate", "x", "y", "heading"}) s.columns[what] = what;
  if (node.has("columns"))
    for (const std::string& key : node.at("columns").keys()) {
      if (!s.columns.contains(key))
        node.at("columns").fail(fmt::format("\"{}\"", key), "time, yaw_rate, x, y or heading");
      s.columns[key] = node.at("columns").at(key).text();
    }
  if (node.has("unit")) {
    const std::string unit = node.at("unit").text();
    if (unit != (gyro ? "rad/s" : "rad") && unit != (gyro ? "deg/s" : "deg"))
      node.at("unit").fail('"' + unit + '"', gyro ? "rad/s or deg/s" : "rad or deg, of headings");
    if (unit.starts_with("deg")) (gyro ? s.rate_scale : s.heading_scale) = kPi / 180;
  }
  if (node.has("standing")) {
    const JsonNode standing = node.at("standing");
    if (!gyro) standing.fail("it of a camera", "it of a yaw_rate");
    for (const std::string& id : standing.keys()) s.standing[id] = number(standing.at(id), kError);
  }
  const JsonNode filter = node.at("filter");
  if (gyro) {
    filter.allow_only({"sigma_yaw_rate"});
    s.stream.sigma_rate = number(filter.at("sigma_yaw_rate"), kSigma);
    s.stream.hold_s = 0.1;  // until the file says how often it measures
    return;
  }
  filter.allow_only({"sigma_position", "sigma_heading"});
  s.stream.sigma_heading = number(filter.at("sigma_heading"), kSigma);
  if (!heading) s.stream.sigma_position = number(filter.at("sigma_position"), kSigma);
}

SyntheticSensor read_sensor(const JsonNode& node) {
  SyntheticSensor s;
  s.stream.name = node.at("name").text();
  s.stream.kind = read_kind(node.at("type"));
  if (node.has("file")) {
    node.allow_only({"name", "type", "file", "columns", "unit", "standing", "delay_s", "filter"});
    s.timing.delay_s = number_or(node, "delay_s", kTime, 0);
    s.timing.rate_hz = 0;
    read_measured(node, s);
    return s;
  }
  node.allow_only({"name", "type", "rate_hz", "delay_s", "missing", "smooth_s", "errors", "filter"});
  s.timing.rate_hz = number(node.at("rate_hz"), kRate);
  s.timing.delay_s = number_or(node, "delay_s", kTime, 0);
  s.timing.missing = number_or(node, "missing", kShare, 0);
  s.timing.smooth_s = number_or(node, "smooth_s", kTime, StreamTiming().smooth_s);
  if (s.stream.kind == SensorKind::YawRate) {
    read_gyro(node, s);
    s.stream.hold_s = 1 / s.timing.rate_hz;
    if (s.timing.delay_s != 0) node.at("delay_s").fail("a delay", "0: the gyro is part of the prediction");
  } else {
    read_camera(node, s);
  }
  return s;
}

std::optional<WalkingState> read_walk(const JsonNode& root, const std::string& key) {
  if (!root.has(key)) return std::nullopt;
  const JsonNode node = root.at(key);
  node.allow_only({"initial", "walk"});
  return WalkingState{number(node.at("initial"), kError), number(node.at("walk"), kError)};
}

// Both generators on a short made-up drive: they refuse what they refuse before any recording is touched.
void try_streams(const SensorsFile& file) {
  Recording r;
  r.id = "check";
  for (int k = 0; k < 4; ++k) {
    r.time_us.push_back(k * 1000);
    r.reference.x.push_back(0);
    r.reference.y.push_back(0);
    r.reference.theta.push_back(0);
  }
  make_streams(file, r, 1);
}

}  // namespace

SensorsFile read_sensors(const std::filesystem::path& path) {
  const JsonNode root = JsonNode::read(path);
  root.allow_only({"description", "seed", "wheels", "start", "sensors", "gyro_bias", "odometry_scale",
                   "gate_probability", "max_delay_s", "unscented"});
  SensorsFile file;
  file.name = path.stem().string();
  file.folder = path.parent_path();
  file.description = root.text_or_empty("description");
  if (root.has("seed")) {
    const std::int64_t seed = root.at("seed").integer();
    if (seed < 0) root.at("seed").fail(fmt::format("{}", seed), "a whole number >= 0");
    file.seed = static_cast<std::uint64_t>(seed);
  }
  FusionOptions& o = file.options;
  file.wheels = root.has("wheels");
  if (file.wheels) {
    const JsonNode wheels = root.at("wheels");
    wheels.allow_only({"sigma_velocity", "sigma_yaw_rate"});
    o.sigma_velocity = number(wheels.at("sigma_velocity"), kSigma);
    o.sigma_yaw_rate = number(wheels.at("sigma_yaw_rate"), kSigma);
  }
  if (root.has("start")) {
    const JsonNode start = root.at("start");
    start.allow_only({"sigma_position", "sigma_heading"});
    o.initial_position = number(start.at("sigma_position"), kSigma);
    o.initial_heading = number(start.at("sigma_heading"), kSigma);
  }
  o.gyro_bias = read_walk(root, "gyro_bias");
  o.odometry_scale = read_walk(root, "odometry_scale");
  o.gate_probability = number_or(root, "gate_probability", kShare, 0);
  o.max_delay_s = number_or(root, "max_delay_s", kTime, o.max_delay_s);
  if (root.has("unscented")) {
    const JsonNode node = root.at("unscented");
    node.allow_only({"alpha", "beta", "kappa"});
    UnscentedOptions& u = o.filter.unscented;
    u = {number_or(node, "alpha", kScatter, u.alpha), number_or(node, "beta", kScatter, u.beta),
         number_or(node, "kappa", kScatter, u.kappa)};
  }
  for (const JsonNode& node : root.at("sensors").elements()) file.sensors.push_back(read_sensor(node));
  if (file.sensors.empty()) root.at("sensors").fail("an empty array", "at least one sensor");
  std::vector<SensorStream> streams;
  for (const SyntheticSensor& s : file.sensors) streams.push_back(s.stream);
  try {
    validate(o, streams);
    try_streams(file);
  } catch (const std::invalid_argument& error) {
    throw DataError(fmt::format("{}: {}", path.string(), error.what()));
  }
  return file;
}

double require_measurements(const SensorsFile& file, std::span<const Recording> recordings) {
  double seconds = 0;
  for (const Recording& r : recordings)
    seconds += (static_cast<double>(r.time_us.back()) - static_cast<double>(r.time_us.front())) * 1e-6;
  double count = 0;
  for (const SyntheticSensor& s : file.sensors) count += seconds * s.timing.rate_hz;
  if (count > kMostMeasurements)
    throw DataError(fmt::format(
        "{}: at these rates the {:.6g} s of the recordings make {:.3g} measurements, expected at most {:.3g}",
        file.name, seconds, count, kMostMeasurements));
  return count;
}

std::vector<SensorStream> make_streams(const SensorsFile& file, const Recording& recording,
                                       std::uint64_t seed) {
  std::vector<SensorStream> streams;
  for (const SyntheticSensor& s : file.sensors) {
    streams.push_back(s.stream);
    if (!s.file.empty()) continue;
    const std::uint64_t own = derive_seed(seed, {"sensor", recording.id, s.stream.name});
    streams.back().data = s.stream.kind == SensorKind::YawRate
                              ? synthetic_gyro(recording, s.gyro, s.timing, own)
                              : synthetic_camera(recording, s.camera, s.timing, own);
  }
  return streams;
}

}  // namespace odobench
