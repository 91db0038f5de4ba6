#include "bench/studies/exporting/controller_keys.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "base/angle.hpp"
#include "base/text.hpp"
#include "bench/studies/exporting/found_values.hpp"
#include "bench/studies/exporting/noise_keys.hpp"

namespace odobench {
namespace {

constexpr const char* kZeros =
    "to the yaw of its steering joint's origin in the URDF, or as an offset into the hardware";

std::string metres(double value) {
  return decimal(value, digits_of("m"));
}
std::string ratio(double value) {
  return decimal(value, digits_of("ratio"));
}

std::string names_list(const std::vector<std::string>& names) {
  return fmt::format("[\"{}\"]", fmt::join(names, "\", \""));
}

void add(KeyTable& table, const std::string& path, const FoundNumber& number) {
  table.keys.push_back({path, decimal(number.value, digits_of(number.unit)), words_of(number)});
}

// One key for several wheels.
void add_mean(KeyTable& table, const std::string& path, const std::vector<FoundNumber>& numbers,
              const std::string& what) {
  const MeanNumber mean = mean_of(numbers);
  std::vector<std::string> names;
  for (const FoundNumber& n : numbers) names.push_back(printable(n.name));
  table.keys.push_back({path, metres(mean.mean),
                        fmt::format("mean of {}, nominal {}", fmt::join(names, ", "), metres(mean.nominal))});
  std::vector<std::string> words;
  for (const FoundNumber& n : numbers) words.push_back(words_of(n));
  table.losses.push_back(
      fmt::format("{} is one {} for all wheels: the mean {} m, half the difference {} m "
                  "is lost ({})",
                  path, what, metres(mean.mean), metres(mean.half_difference), fmt::join(words, "; ")));
}

void add_zero(KeyTable& table, const FoundNumber& zero) {
  table.elsewhere.push_back(fmt::format("{}: has no key; it belongs {}", words_of(zero), kZeros));
}

void refuse_no_length(double value, const std::string& name) {
  if (value == 0)
    throw std::invalid_argument(fmt::format(
        "multipliers are relative to nominal values, and that of {} is 0: give --absolute", name));
}

void differential_keys(const FoundNumber& track, const FoundValues& values, bool absolute, KeyTable& table) {
  const FoundNumber left = values.at("r_left"), right = values.at("r_right");
  const MeanNumber radius = mean_of({left, right});
  const double separation = absolute ? track.value : track.nominal;
  const double wheel = absolute ? radius.mean : radius.nominal;
  refuse_no_length(separation, track.name);
  refuse_no_length(wheel, "the radii");
  table.controller = "diff_drive_controller";
  table.keys = {
      {"left_wheel_names", names_list({"left_wheel_joint"}), "as your URDF calls them"},
      {"right_wheel_names", names_list({"right_wheel_joint"}), ""},
      {"wheel_separation", metres(separation), absolute ? words_of(track) : "nominal, as in the URDF"},
      {"wheel_radius", metres(wheel),
       absolute ? "mean of both, nominal " + metres(radius.nominal) : "nominal, as in the URDF"},
      {"wheel_separation_multiplier", ratio(track.value / separation), words_of(track)},
      {"left_wheel_radius_multiplier", ratio(left.value / wheel), words_of(left)},
      {"right_wheel_radius_multiplier", ratio(right.value / wheel), words_of(right)}};
  table.statements.push_back(
      absolute
          ? "wheel_separation and wheel_radius are calibrated; the radii differ by their multipliers"
          : "wheel_separation and wheel_radius are nominal, as in the URDF; the calibration stands in the "
            "multipliers");
}

void differential(const FoundValues& values, bool absolute, KeyTable& table) {
  differential_keys(values.at("b"), values, absolute, table);
}

// The slip makes a wider track of the real one, which stands in the URDF.
void skid_steer(const FoundValues& values, bool absolute, KeyTable& table) {
  const FoundNumber slip = values.at("slip");
  refuse_no_length(slip.nominal, slip.name);
  const auto track_of = [](const std::vector<Wheel>& wheels) {
    double right = 0, left = 0;
    for (const Wheel& wheel : wheels) {
      right = std::min(right, wheel.y);
      left = std::max(left, wheel.y);
    }
    return left - right;
  };
  const double real = track_of(values.file().nominal_wheels) / slip.nominal;
  FoundNumber track{"slip * b", "m", track_of(values.file().wheels), real, std::nullopt};
  if (slip.half_width) track.half_width = *slip.half_width * real;
  differential_keys(track, values, absolute, table);
}

void tricycle(const FoundValues& values, KeyTable& table) {
  table.controller = "tricycle_controller";
  table.keys = {{"traction_joint_name", "\"traction_joint\"", "as your URDF calls it"},
                {"steering_joint_name", "\"steering_joint\"", ""}};
  add(table, "wheelbase", values.at("wheelbase"));
  add(table, "wheel_radius", values.at("r"));
  add_zero(table, values.at("steering_zero"));
}

void steering_joints(const std::vector<std::string>& traction, const std::vector<std::string>& steering,
                     KeyTable& table) {
  table.keys.push_back(
      {"traction_joints_names", names_list(traction),
       traction.size() > 1 ? "right before left, as your URDF calls them" : "as your URDF calls it"});
  table.keys.push_back({"steering_joints_names", names_list(steering), ""});
}

void bicycle(const FoundValues& values, KeyTable& table) {
  table.controller = "bicycle_steering_controller";
  steering_joints({"rear_wheel_joint"}, {"steering_joint"}, table);
  const FoundNumber radius = values.at("r");
  add(table, "wheelbase", values.at("wheelbase"));
  add(table, "traction_wheel_radius", radius);
  add_zero(table, values.at("steering_zero"));
  const FoundNumber gain = values.at("gain");
  table.elsewhere.push_back(fmt::format(
      "{}: has no key; it belongs as a factor of the steering angle into the hardware", words_of(gain)));
  table.statements.push_back(
      fmt::format("with two driven wheels in tricycle_steering_controller: the same wheelbase, "
                  "traction_wheels_radius: {}, "
                  "and traction_track_width, which this class does not have",
                  metres(radius.value)));
}

void ackermann(const FoundValues& values, KeyTable& table) {
  table.controller = "ackermann_steering_controller";
  steering_joints({"rear_right_wheel_joint", "rear_left_wheel_joint"},
                  {"front_right_steering_joint", "front_left_steering_joint"}, table);
  add(table, "wheelbase", values.at("wheelbase"));
  add(table, "traction_track_width", values.at("b"));
  add(table, "steering_track_width", values.at("b_front"));
  add_mean(table, "traction_wheels_radius", {values.at("r_right"), values.at("r_left")}, "radius");
  add_zero(table, values.at("zero_right"));
  add_zero(table, values.at("zero_left"));
  table.statements.push_back(
      "in releases before: rear_wheel_track for traction_track_width, front_wheel_track for "
      "steering_track_width");
}

// The controller turns by u / (4 sum), this robot by u / (4 (ly + lx tan g)); lx and ly act in no other way.
void mecanum(const FoundValues& values, KeyTable& table) {
  const FoundNumber lx = values.at("lx"), ly = values.at("ly"), roller = values.at("roller");
  const double slope = std::tan(roller.value);
  table.controller = "mecanum_drive_controller";
  add_mean(table, "kinematics.wheels_radius", values.numbered("r"), "radius");
  table.keys.push_back({"kinematics.sum_of_robot_center_projection_on_X_Y_axis",
                        metres(ly.value + lx.value * slope),
                        fmt::format("ly + lx tan(roller); lx + ly = {}, nominal {}",
                                    metres(lx.value + ly.value), metres(lx.nominal + ly.nominal))});
  for (const char* key : {"x", "y", "theta"})
    table.keys.push_back({fmt::format("kinematics.base_frame_offset.{}", key), "0.0", ""});
  table.elsewhere.push_back(words_of(lx) + ": stands in the sum");
  table.elsewhere.push_back(words_of(ly) + ": stands in the sum");
  if (std::abs(slope - 1) > 1e-9)
    table.losses.push_back(
        fmt::format("rollers are taken as at 45 degrees: velocities sideways are {} times the real ones ({})",
                    ratio(slope), words_of(roller)));
}

void omni(const FoundValues& values, KeyTable& table) {
  const std::vector<Wheel>& wheels = values.file().nominal_wheels;
  const std::vector<std::string> names = wheel_names(values.file());
  std::vector<std::pair<double, std::size_t>> order;  // anti-clockwise from +x
  for (std::size_t i = 0; i < wheels.size(); ++i) {
    const double angle = std::atan2(wheels[i].y, wheels[i].x);
    order.emplace_back(angle < -1e-9 ? angle + 2 * kPi : std::max(0.0, angle), i);
  }
  std::sort(order.begin(), order.end());
  std::vector<std::string> joints;
  double clockwise = 0;
  for (const auto& [angle, i] : order) {
    joints.push_back(names[i] + "_joint");
    clockwise += std::cos(wheels[i].mount) * std::sin(angle) - std::sin(wheels[i].mount) * std::cos(angle);
  }
  table.controller = "omni_wheel_drive_controller";
  table.keys = {{"wheel_names", names_list(joints), "anti-clockwise from +x, as your URDF calls them"},
                {"wheel_offset", decimal(order.front().first, 6), "of the first wheel from +x, rad"}};
  const bool full = values.has("R1");
  if (full)
    add_mean(table, "robot_radius", values.numbered("R"), "distance");
  else
    add(table, "robot_radius", values.at("R"));
  add_mean(table, "wheel_radius", values.numbered("r"), "radius");
  if (full)
    for (const FoundNumber& mount : values.numbered("mount"))
      table.losses.push_back(words_of(mount) + ": wheels are taken as evenly spaced; it has no key");
  if (clockwise < 0)
    table.statements.push_back(
        "the controller counts wheels forward that turn the robot clockwise, this set anti-clockwise: turn "
        "the "
        "joints' axes round");
}

// One module in each quadrant is what ROS 1 knows: a rectangle with one radius.
void four_wheel_steering(const FoundValues& values, KeyTable& table) {
  const ParameterFile& file = values.file();
  const std::vector<std::size_t> at = quadrants(file);
  table.statements.push_back("ros2_controllers has none for this robot: its numbers wheel by wheel");
  table.controller = "swerve_controller";
  if (!at.empty()) {
    table.controller = "four_wheel_steering_controller";
    table.statements.push_back(
        "track, wheel_base, wheel_radius, wheel_steering_y_offset are the keys of ROS 1's "
        "four_wheel_steering_controller");
    const auto rectangle = [&](const std::vector<Wheel>& wheels, double& track, double& base, double& out) {
      track = (wheels[at[0]].y - wheels[at[1]].y + wheels[at[2]].y - wheels[at[3]].y) / 2;
      base = (wheels[at[0]].x + wheels[at[1]].x - wheels[at[2]].x - wheels[at[3]].x) / 2;
      out = (wheels[at[0]].offset - wheels[at[1]].offset + wheels[at[2]].offset - wheels[at[3]].offset) / 4;
    };
    double track = 0, base = 0, out = 0, nominal_track = 0, nominal_base = 0, nominal_out = 0;
    rectangle(file.wheels, track, base, out);
    rectangle(file.nominal_wheels, nominal_track, nominal_base, nominal_out);
    table.keys = {{"track", metres(track + 2 * out), "nominal " + metres(nominal_track + 2 * nominal_out)},
                  {"wheel_base", metres(base), "nominal " + metres(nominal_base)}};
    add_mean(table, "wheel_radius", values.numbered("r"), "radius");
    table.keys.push_back({"wheel_steering_y_offset", metres(out), "nominal " + metres(nominal_out)});
    double worst = 0;
    constexpr std::array<double, 4> kAhead = {1, 1, -1, -1}, kLeft = {1, -1, 1, -1};
    for (std::size_t k = 0; k < at.size(); ++k)
      worst = std::max(worst, std::hypot(file.wheels[at[k]].x - kAhead[k] * base / 2,
                                         file.wheels[at[k]].y - kLeft[k] * track / 2));
    table.losses.push_back(
        fmt::format("track and wheel_base are a rectangle round the origin: a wheel stands up to {} m off it",
                    metres(worst)));
  }
  add_wheel_keys(file, table);
  for (std::size_t i = 1; i <= file.wheels.size(); ++i)
    if (const std::string zero = fmt::format("zero{}", i); values.has(zero)) add_zero(table, values.at(zero));
}

void refuse_backwards(const ParameterFile& file) {
  for (const FoundParameter& found : file.parameters)
    if (found.parameter.unit == "m" && found.parameter.name.starts_with("r") && found.parameter.value < 0)
      throw std::invalid_argument(fmt::format(
          "{} is negative: its encoder counts backwards, which controllers do not know; turn the joint round "
          "and calibrate again, or take --to=yaml",
          printable(found.parameter.name)));
}

}  // namespace

KeyTable controller_keys(const ParameterFile& file, bool absolute) {
  const FoundValues values(file);
  KeyTable table;
  const std::string& kind = file.kinematics;
  if (kind == "differential")
    differential(values, absolute, table);
  else if (kind == "skid_steer")
    skid_steer(values, absolute, table);
  else if (kind == "tricycle")
    tricycle(values, table);
  else if (kind == "bicycle")
    bicycle(values, table);
  else if (kind == "ackermann")
    ackermann(values, table);
  else if (kind == "mecanum")
    mecanum(values, table);
  else if (kind.starts_with("omni"))
    omni(values, table);
  else if (kind.starts_with("swerve") || kind == "4wis4wid")
    four_wheel_steering(values, table);
  else
    throw std::invalid_argument(
        fmt::format("--to=ros2: no controller for a robot of class '{}'; --to=yaml has its numbers wheel by "
                    "wheel",
                    shown(kind)));
  refuse_backwards(file);
  add_noise_keys(file, !kind.starts_with("swerve") && kind != "4wis4wid", table);
  return table;
}

void add_wheel_keys(const ParameterFile& file, KeyTable& table) {
  const std::vector<std::string> names = wheel_names(file);
  for (std::size_t i = 0; i < file.wheels.size(); ++i) {
    const Wheel &wheel = file.wheels[i], &nominal = file.nominal_wheels[i];
    const auto key = [&](const char* name, double Wheel::*field, const char* unit) {
      table.keys.push_back({fmt::format("wheels.{}.{}", names[i], name), decimal(wheel.*field, 6),
                            fmt::format("{}, nominal {}", unit, decimal(nominal.*field, 6))});
    };
    const bool steered = !wheel.steering.empty();
    key("x", &Wheel::x, "m");
    key("y", &Wheel::y, "m");
    if (!wheel.drive.empty()) key("radius", &Wheel::radius, "m");
    if (wheel.mount != 0 || nominal.mount != 0) key("mount", &Wheel::mount, "rad");
    if (wheel.roller != 0) key("roller", &Wheel::roller, "rad");
    if (steered) key("steering_offset", &Wheel::zero, "rad");
    if (steered && (wheel.gain != 1 || nominal.gain != 1)) key("steering_gain", &Wheel::gain, "ratio");
    if (wheel.offset != 0) key("contact_left", &Wheel::offset, "m");
    if (wheel.trail != 0) key("contact_ahead", &Wheel::trail, "m");
  }
}

KeyTable generic_keys(const ParameterFile& file) {
  KeyTable table;
  table.controller = "odometry";
  for (const FoundParameter& found : file.parameters) {
    const ParameterValue& p = found.parameter;
    std::string name = p.name;
    std::replace(name.begin(), name.end(), '.', '_');
    table.keys.push_back(
        {"parameters." + name, decimal(p.value, digits_of(p.unit)),
         remark_on({p.name, p.unit, p.value, p.nominal, found.half_width, p.at_bound, found.decided_by})});
  }
  add_wheel_keys(file, table);
  add_noise_terms(file, table);
  return table;
}

}  // namespace odobench
