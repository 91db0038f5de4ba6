#include "bench/sensors_file.hpp"

#include <fmt/format.h>

#include <initializer_list>
#include <stdexcept>

#include "base/json_node.hpp"
#include "solvers/random.hpp"

namespace odobench {
namespace {

double number_or(const JsonNode& node, const std::string& key, double otherwise) {
  return node.has(key) ? node.at(key).number() : otherwise;
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
  s.gyro = {number_or(errors, "bias", 0), number_or(errors, "bias_walk", 0), number_or(errors, "noise", 0)};
  s.stream.sigma_rate = filter.at("sigma_yaw_rate").number();
}

void read_camera(const JsonNode& node, SyntheticSensor& s) {
  const JsonNode errors = node.at("errors"), filter = node.at("filter");
  errors.allow_only(
      {"scale", "scale_mean", "position_walk", "heading_walk", "position_noise", "heading_noise"});
  s.camera = {number_or(errors, "scale", 0),          number_or(errors, "scale_mean", 0),
              number_or(errors, "position_walk", 0),  number_or(errors, "heading_walk", 0),
              number_or(errors, "position_noise", 0), number_or(errors, "heading_noise", 0)};
  s.stream.sigma_heading = filter.at("sigma_heading").number();
  if (s.stream.kind == SensorKind::Heading) {
    filter.allow_only({"sigma_heading"});
    return;
  }
  filter.allow_only({"sigma_position", "sigma_heading"});
  s.stream.sigma_position = filter.at("sigma_position").number();
}

SyntheticSensor read_sensor(const JsonNode& node) {
  node.allow_only({"name", "type", "rate_hz", "delay_s", "missing", "smooth_s", "errors", "filter"});
  SyntheticSensor s;
  s.stream.name = node.at("name").text();
  s.stream.kind = read_kind(node.at("type"));
  s.timing.rate_hz = node.at("rate_hz").number();
  s.timing.delay_s = number_or(node, "delay_s", 0);
  s.timing.missing = number_or(node, "missing", 0);
  s.timing.smooth_s = number_or(node, "smooth_s", StreamTiming().smooth_s);
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
  return WalkingState{node.at("initial").number(), node.at("walk").number()};
}

// Both generators on a short made-up drive: they refuse what they refuse before any recording is touched.
void try_streams(const SensorsFile& file) {
  Recording r;
  r.id = "check";
  for (int k = 0; k < 4; ++k) {
    r.time_us.push_back(k * 1000);
    r.x.push_back(0);
    r.y.push_back(0);
    r.theta.push_back(0);
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
  file.description = root.text_or_empty("description");
  if (root.has("seed")) {
    const std::int64_t seed = root.at("seed").integer();
    if (seed < 0) root.at("seed").fail(fmt::format("{}", seed), "a whole number >= 0");
    file.seed = static_cast<std::uint64_t>(seed);
  }
  FusionOptions& o = file.options;
  const JsonNode wheels = root.at("wheels");
  wheels.allow_only({"sigma_velocity", "sigma_yaw_rate"});
  o.sigma_velocity = wheels.at("sigma_velocity").number();
  o.sigma_yaw_rate = wheels.at("sigma_yaw_rate").number();
  if (root.has("start")) {
    const JsonNode start = root.at("start");
    start.allow_only({"sigma_position", "sigma_heading"});
    o.initial_position = start.at("sigma_position").number();
    o.initial_heading = start.at("sigma_heading").number();
  }
  o.gyro_bias = read_walk(root, "gyro_bias");
  o.odometry_scale = read_walk(root, "odometry_scale");
  o.gate_probability = number_or(root, "gate_probability", 0);
  o.max_delay_s = number_or(root, "max_delay_s", o.max_delay_s);
  if (root.has("unscented")) {
    const JsonNode node = root.at("unscented");
    node.allow_only({"alpha", "beta", "kappa"});
    UnscentedOptions& u = o.filter.unscented;
    u = {number_or(node, "alpha", u.alpha), number_or(node, "beta", u.beta),
         number_or(node, "kappa", u.kappa)};
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

std::vector<SensorStream> make_streams(const SensorsFile& file, const Recording& recording,
                                       std::uint64_t seed) {
  std::vector<SensorStream> streams;
  for (const SyntheticSensor& s : file.sensors) {
    streams.push_back(s.stream);
    const std::uint64_t own = derive_seed(seed, {"sensor", recording.id, s.stream.name});
    streams.back().data = s.stream.kind == SensorKind::YawRate
                              ? synthetic_gyro(recording, s.gyro, s.timing, own)
                              : synthetic_camera(recording, s.camera, s.timing, own);
  }
  return streams;
}

}  // namespace odobench
