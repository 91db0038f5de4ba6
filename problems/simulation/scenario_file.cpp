#include "problems/simulation/scenario_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/angle.hpp"

namespace odobench::simulate {
namespace {

constexpr double kRpm = 2 * kPi / 60;

void number(const JsonNode& node, const char* key, double& value, double unit = 1) {
  if (node.has(key)) value = node.at(key).number() * unit;
}

void range(const JsonNode& node, const char* key, Range& value) {
  if (!node.has(key)) return;
  const std::vector<double> ends = node.at(key).numbers();
  if (ends.size() != 2) node.at(key).fail(fmt::format("{} numbers", ends.size()), "two, low and high");
  value = {ends[0], ends[1]};
}

PerWheel per_wheel(const JsonNode& node, double unit) {
  const std::vector<double> values = node.numbers();
  if (values.size() != kWheelCount)
    node.fail(fmt::format("{} numbers", values.size()), "four, one per wheel");
  PerWheel wheels{};
  for (std::size_t i = 0; i < kWheelCount; ++i) wheels[i] = values[i] * unit;
  return wheels;
}

// The geometry that the robot's makers state, and how far the true one may be from it.
void read_nominal(const JsonNode& node, Robot& robot) {
  double box = 0.05;
  if (node.has("box")) {
    box = node.at("box").number();
    if (!(box > 0) || !(box < 1)) node.at("box").fail(fmt::format("{}", box), "a share above 0 and below 1");
  }
  const Parameters nominal =
      node.has("nominal") ? read_parameters(node.at("nominal"), robot) : nominal_parameters(robot);
  std::vector<RobotParameter> parameters = robot.parameters;
  for (std::size_t i = 0; i < nominal.size(); ++i) {
    RobotParameter& p = parameters[i];
    const double a = nominal[i] * (1 - box), b = nominal[i] * (1 + box);
    p = {p.name, p.unit, nominal[i], std::min(a, b), std::max(a, b)};
  }
  const std::string name = robot.name;
  robot = robot_of_class(robot.kinematics, parameters);
  robot.name = name;
}

// A truth that no calibration may find is a mistake, most often a nominal geometry that was left out.
void require_truth_in_box(const JsonNode& truth, const RecordingScenario& s) {
  for (std::size_t i = 0; i < s.truth.parameters.size(); ++i) {
    const RobotParameter& p = s.robot.parameters[i];
    const double value = s.truth.parameters[i];
    if (value < p.lower || value > p.upper)
      truth.fail(
          fmt::format("{} = {}", p.name, value),
          fmt::format("a value in the robot's box [{:.6g}, {:.6g}] about its nominal {:.6g}: /robot/nominal "
                      "states the geometry of a robot of your own, /robot/box how far the truth may be off",
                      p.lower, p.upper, p.nominal));
  }
}

void read_robot(const JsonNode& node, RecordingScenario& s) {
  node.allow_only({"nominal", "box", "truth", "kinematics", "contact_offset_m", "steering_limit_deg"});
  if (node.has("nominal") || node.has("box")) read_nominal(node, s.robot);
  s.truth.parameters = s.control.believed = nominal_parameters(s.robot);
  if (node.has("truth")) s.truth.parameters = read_parameters(node.at("truth"), s.robot);
  if (node.has("kinematics")) {
    const JsonNode kinematics = node.at("kinematics");
    const std::string name = kinematics.text();
    if (name != "published" && name != "least-squares")
      kinematics.fail(fmt::format("\"{}\"", name), "published or least-squares");
    s.truth.kinematics = name == "published" ? Kinematics::Published : Kinematics::LeastSquares;
  }
  if (node.has("contact_offset_m")) s.truth.contact_offset = per_wheel(node.at("contact_offset_m"), 1);
  number(node, "steering_limit_deg", s.truth.steering_limit, kDegree);
}

Phase read_phase(const JsonNode& node) {
  Phase phase;
  number(node, "vx_m_s", phase.twist.vx);
  number(node, "vy_m_s", phase.twist.vy);
  number(node, "omega_rad_s", phase.twist.omega);
  phase.duration_s = node.at("duration_s").number();
  return phase;
}

Drive read_drive(const JsonNode& node, const std::vector<Drive>& known) {
  if (!node.has("name")) {  // the name of a known drive
    const std::string name = node.text();
    const auto same = [&name](const Drive& d) { return d.name == name; };
    const auto drive = std::find_if(known.begin(), known.end(), same);
    if (drive != known.end()) return *drive;
    std::string list;
    for (const Drive& d : known) list += (list.empty() ? "" : ", ") + d.name;
    node.fail(fmt::format("\"{}\"", name), "an object, or one of " + list);
  }
  Drive drive{node.at("name").text(), node.text_or_empty("description"), {}, {}, {1, 1, 1, 1}};
  if (node.has("steering_offset_deg"))
    drive.steering_offset = per_wheel(node.at("steering_offset_deg"), kDegree);
  if (node.has("speed_factor")) drive.speed_factor = per_wheel(node.at("speed_factor"), 1);
  if (node.has("phases")) {
    node.allow_only({"name", "description", "steering_offset_deg", "speed_factor", "phases"});
    for (const JsonNode& phase : node.at("phases").elements()) {
      phase.allow_only({"vx_m_s", "vy_m_s", "omega_rad_s", "duration_s"});
      drive.phases.push_back(read_phase(phase));
    }
  } else {
    node.allow_only({"name", "description", "steering_offset_deg", "speed_factor", "vx_m_s", "vy_m_s",
                     "omega_rad_s", "duration_s"});
    drive.phases.push_back(read_phase(node));
  }
  return drive;
}

void read_control(const JsonNode& node, RecordingScenario& s) {
  Control& c = s.control;
  node.allow_only({"mode", "believed", "gain_position", "gain_heading", "delay_s", "lead_s", "wheel_lag_s",
                   "steering_rate_rad_s", "steering_bias_rad", "steering_wander_rad", "wander_time_s"});
  if (node.has("mode")) {
    const std::string mode = node.at("mode").text();
    if (mode != "closed_loop" && mode != "open_loop")
      node.at("mode").fail(fmt::format("\"{}\"", mode), "closed_loop or open_loop");
    c.closed_loop = mode == "closed_loop";
    for (const char* key : {"gain_position", "gain_heading", "delay_s", "lead_s"})
      if (!c.closed_loop && node.has(key))
        node.at(key).fail("contradictory options: it belongs to the closed loop and mode is open_loop",
                          "one or the other");
  }
  if (node.has("believed")) c.believed = read_parameters(node.at("believed"), s.robot);
  number(node, "gain_position", c.gain_position);
  number(node, "gain_heading", c.gain_heading);
  number(node, "delay_s", c.delay_s);
  range(node, "lead_s", c.lead_s);
  number(node, "wheel_lag_s", c.wheel_lag_s);
  number(node, "steering_rate_rad_s", c.steering_rate);
  number(node, "steering_bias_rad", c.steering_bias);
  number(node, "steering_wander_rad", c.steering_wander);
  number(node, "wander_time_s", c.wander_time_s);
}

void read_odometry(const JsonNode& node, Odometry& o) {
  node.allow_only({"rate_hz", "speed_quantum_rpm", "steering_quantum_rad", "speed_noise_rad_s",
                   "stamp_jitter_s", "on_time", "on_time_s", "delay_s", "stall_probability", "stall_s"});
  number(node, "rate_hz", o.rate_hz);
  number(node, "speed_quantum_rpm", o.speed_quantum, kRpm);
  number(node, "steering_quantum_rad", o.steering_quantum);
  number(node, "speed_noise_rad_s", o.speed_noise);
  number(node, "stamp_jitter_s", o.stamp_jitter_s);
  number(node, "on_time", o.on_time);
  number(node, "on_time_s", o.on_time_s);
  number(node, "delay_s", o.delay_s);
  number(node, "stall_probability", o.stall_probability);
  range(node, "stall_s", o.stall_s);
}

void read_capture(const JsonNode& node, Capture& c) {
  node.allow_only({"rate_hz", "poll_s", "delay_s", "stall_probability", "stall_s", "loss", "position_noise_m",
                   "heading_noise_rad"});
  number(node, "rate_hz", c.rate_hz);
  number(node, "poll_s", c.poll_s);
  number(node, "delay_s", c.delay_s);
  number(node, "stall_probability", c.stall_probability);
  range(node, "stall_s", c.stall_s);
  range(node, "loss", c.loss);
  number(node, "position_noise_m", c.position_noise);
  number(node, "heading_noise_rad", c.heading_noise);
}

void read_slip(const JsonNode& node, Slip& slip) {
  node.allow_only({"fixed", "random", "yaw_bias_rad_s", "gains"});
  number(node, "fixed", slip.fixed);
  number(node, "random", slip.random);
  number(node, "yaw_bias_rad_s", slip.yaw_bias);
  if (!node.has("gains")) return;
  const JsonNode gains = node.at("gains");
  for (const std::string& name : gains.keys()) {
    gains.at(name).allow_only({"linear", "angular"});
    number(gains.at(name), "linear", slip.gains[name].linear);
    number(gains.at(name), "angular", slip.gains[name].angular);
  }
}

}  // namespace

ScenarioHead read_head(const JsonNode& root) {
  const std::string schema = root.at("schema").text();
  if (schema != kScenarioSchema)
    root.at("schema").fail(fmt::format("\"{}\"", schema), fmt::format("\"{}\"", kScenarioSchema));
  const std::int64_t version = root.at("schema_version").integer();
  if (version != kScenarioSchemaVersion)
    root.at("schema_version").fail(fmt::format("{}", version), fmt::format("{}", kScenarioSchemaVersion));
  ScenarioHead head{root.at("kind").text(), root.at("name").text(), root.text_or_empty("description")};
  if (head.kind != "recordings" && head.kind != "dynamics")
    root.at("kind").fail(fmt::format("\"{}\"", head.kind), "recordings or dynamics");
  if (head.name.empty()) root.at("name").fail("an empty text", "a name");
  return head;
}

Parameters read_parameters(const JsonNode& node, const Robot& robot) {
  Parameters z = nominal_parameters(robot);
  bool object = true;
  try {
    (void)node.keys();
  } catch (const DataError&) {
    object = false;
  }
  if (!object) {
    if (node.text() != "nominal") node.fail(fmt::format("\"{}\"", node.text()), "\"nominal\" or an object");
    return z;
  }
  for (const std::string& key : node.keys()) {
    const auto same = [&key](const RobotParameter& p) { return p.name == key; };
    const auto found = std::find_if(robot.parameters.begin(), robot.parameters.end(), same);
    if (found == robot.parameters.end())
      node.fail(fmt::format("unknown key \"{}\"", key), "a1 .. a4, b1 .. b4, r1 .. r4");
    z[static_cast<std::size_t>(found - robot.parameters.begin())] = node.at(key).number();
  }
  return z;
}

RecordingScenario read_scenario(const JsonNode& root) {
  const ScenarioHead head = read_head(root);
  root.allow_only({"schema", "schema_version", "kind", "name", "description", "exact", "robot", "drives",
                   "repetitions", "control", "odometry", "capture", "idle", "start", "slip"});
  if (head.kind != "recordings") root.at("kind").fail(fmt::format("\"{}\"", head.kind), "recordings");
  RecordingScenario s = default_scenario();
  s.name = head.name;
  s.description = head.description;
  if (root.has("exact")) s.exact = root.at("exact").boolean();
  s.control.closed_loop = !s.exact;
  if (root.has("robot")) read_robot(root.at("robot"), s);
  if (root.has("drives")) {
    s.drives.clear();
    const std::vector<Drive> known = known_drives();
    for (const JsonNode& drive : root.at("drives").elements()) s.drives.push_back(read_drive(drive, known));
  }
  if (root.has("repetitions")) {
    const std::int64_t count = root.at("repetitions").integer();
    if (count < 1 || count > 10'000) root.at("repetitions").fail(fmt::format("{}", count), "1 to 10000");
    s.repetitions = static_cast<int>(count);
  }
  if (root.has("control")) read_control(root.at("control"), s);
  if (root.has("odometry")) read_odometry(root.at("odometry"), s.odometry);
  if (root.has("capture")) read_capture(root.at("capture"), s.capture);
  if (root.has("idle")) {
    root.at("idle").allow_only({"before_s", "after_s"});
    range(root.at("idle"), "before_s", s.idle.before_s);
    range(root.at("idle"), "after_s", s.idle.after_s);
  }
  if (root.has("start")) {
    root.at("start").allow_only({"position_m", "heading_rad"});
    number(root.at("start"), "position_m", s.start.position);
    number(root.at("start"), "heading_rad", s.start.heading);
  }
  if (root.has("slip")) read_slip(root.at("slip"), s.slip);
  for (const char* key : {"capture", "idle", "start"})
    if (s.exact && root.has(key))
      root.at(key).fail("contradictory options: an exact scenario has no noise and no jitter",
                        "one or the other");
  validate(s, root.file());
  if (root.has("robot") && root.at("robot").has("truth"))
    require_truth_in_box(root.at("robot").at("truth"), s);
  return s;
}

}  // namespace odobench::simulate
