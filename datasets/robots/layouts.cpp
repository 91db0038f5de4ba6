#include "datasets/robots/layouts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <stdexcept>

#include "base/angle.hpp"
#include "base/names.hpp"

namespace odobench::robots {

// Hands out what was given, or the default, and remembers what was asked for.
class DimensionReader {
 public:
  explicit DimensionReader(const Dimensions& given) : given_(given) {}

  double number(const std::string& name, double otherwise) {
    const auto found = given_.find(name);
    const double value = found == given_.end() ? otherwise : found->second;
    if (!std::isfinite(value)) throw std::invalid_argument(fmt::format("dimension '{}' is not finite", name));
    if (names_.insert(name).second) asked_.push_back({name, value});
    return value;
  }
  double length(const std::string& name, double otherwise) {
    const double value = number(name, otherwise);
    if (!(value > 0))
      throw std::invalid_argument(fmt::format("dimension '{}' is {}, expected more than 0", name, value));
    return value;
  }
  int count(const std::string& name, int otherwise, int least, int most) {
    const double value = number(name, otherwise);
    if (value != std::floor(value) || value < least || value > most)
      throw std::invalid_argument(fmt::format("dimension '{}' is {}, expected a whole number from {} to {}",
                                              name, value, least, most));
    return static_cast<int>(value);
  }

  const std::vector<Dimension>& asked() const { return asked_; }
  void refuse_unused(const std::string& layout) const {
    std::vector<std::string> known;
    for (const Dimension& d : asked_) known.push_back(d.name);
    for (const auto& [name, value] : given_)
      if (!names_.contains(name))
        throw std::invalid_argument(
            fmt::format("{} has no dimension '{}'{}", layout, name, did_you_mean(name, known)));
  }

 private:
  const Dimensions& given_;
  std::set<std::string> names_;
  std::vector<Dimension> asked_;
};

namespace {

constexpr double kShare = 0.15;         // of a length to either side
constexpr double kAngleBox = 0.1;       // rad, of zeros and mounts
constexpr double kGainBox = 0.1;        // of 1
constexpr double kSteadyRadius = 0.05;  // m, of wheels whose radius has no effect

using enum WheelField;

RobotParameter around(const std::string& name, const std::string& unit, double nominal, double box) {
  return {name, unit, nominal, nominal - box, nominal + box};
}
RobotParameter length_parameter(const std::string& name, double nominal, double share = kShare) {
  const double a = nominal * (1 - share), b = nominal * (1 + share);
  return {name, "m", nominal, std::min(a, b), std::max(a, b)};
}
RobotParameter angle_parameter(const std::string& name, double nominal) {
  return around(name, "rad", nominal, kAngleBox);
}

Wheel fixed_wheel(const std::string& drive) {
  Wheel w;
  if (!drive.empty()) w.drive = {{drive, 1}};
  if (drive.empty()) w.radius = kSteadyRadius;
  return w;
}
Wheel steered_wheel(const std::string& drive, const std::string& steering) {
  Wheel w = fixed_wheel(drive);
  w.steering = steering;
  return w;
}
Wheel sliding_wheel(const std::string& drive) {
  Wheel w = fixed_wheel(drive);
  w.slides = true;
  return w;
}
std::string numbered(const std::string& name, std::size_t wheel) {
  return fmt::format("{}{}", name, wheel + 1);
}
std::string numbered_signal(const std::string& name, std::size_t wheel) {
  return fmt::format("{}.{}", name, wheel + 1);
}

// Right wheel, left wheel, on the axle through the origin.
WheelTable differential_robot(DimensionReader& d) {
  const double b = d.length("b", 0.3), r = d.length("r", 0.05);
  WheelTable t;
  t.wheels = {fixed_wheel("wheel.right"), fixed_wheel("wheel.left")};
  t.parameters = {{length_parameter("b", b), {{0, Y, -0.5}, {1, Y, 0.5}}},
                  {length_parameter("r_right", d.length("r_right", r)), {{0, Radius}}},
                  {length_parameter("r_left", d.length("r_left", r)), {{1, Radius}}}};
  return t;
}

// A differential robot whose wheels slip sideways when it turns acts as one with a wider track: slip b.
WheelTable skid_steer_robot(DimensionReader& d) {
  const double b = d.length("b", 0.5), r = d.length("r", 0.1), slip = d.length("slip", 1.5);
  WheelTable t;
  t.wheels = {fixed_wheel("wheel.right"), fixed_wheel("wheel.left")};
  t.parameters = {
      {{"slip", "ratio", slip, std::min(1.0, slip), std::max(3.0, slip)}, {{0, Y, -b / 2}, {1, Y, b / 2}}},
      {length_parameter("r_right", d.length("r_right", r)), {{0, Radius}}},
      {length_parameter("r_left", d.length("r_left", r)), {{1, Radius}}}};
  return t;
}

// Front wheel, and two passive ones on the axle through the origin, wherever on it they stand.
WheelTable tricycle_robot(DimensionReader& d) {
  WheelTable t;
  t.wheels = {steered_wheel("wheel", "steering"), fixed_wheel(""), fixed_wheel("")};
  t.wheels[1].y = 0.1;
  t.wheels[2].y = -0.1;
  t.parameters = {{length_parameter("wheelbase", d.length("wheelbase", 1.0)), {{0, X}}},
                  {length_parameter("r", d.length("r", 0.1)), {{0, Radius}}},
                  {angle_parameter("steering_zero", d.number("steering_zero", 0)), {{0, Zero}}}};
  return t;
}

// One rear wheel that turns as the mean of two, one front wheel.
WheelTable bicycle_robot(DimensionReader& d) {
  WheelTable t;
  t.wheels = {fixed_wheel(""), steered_wheel("", "steering")};
  t.wheels[0].drive = {{"wheel.right", 0.5}, {"wheel.left", 0.5}};
  t.wheels[0].radius = 0;
  t.wheels[1].gain = 0;
  t.parameters = {{length_parameter("wheelbase", d.length("wheelbase", 1.0)), {{1, X}}},
                  {length_parameter("r", d.length("r", 0.1)), {{0, Radius}}},
                  {angle_parameter("steering_zero", d.number("steering_zero", 0)), {{1, Zero}}},
                  {around("gain", "ratio", d.number("gain", 1), kGainBox), {{1, Gain}}}};
  return t;
}

// Rear right, rear left, front right, front left.
WheelTable ackermann_robot(DimensionReader& d) {
  const double b = d.length("b", 0.6), r = d.length("r", 0.1);
  WheelTable t;
  t.wheels = {fixed_wheel("wheel.right"), fixed_wheel("wheel.left"), steered_wheel("", "steering.right"),
              steered_wheel("", "steering.left")};
  t.parameters = {{length_parameter("b", b), {{0, Y, -0.5}, {1, Y, 0.5}}},
                  {length_parameter("wheelbase", d.length("wheelbase", 1.0)), {{2, X}, {3, X}}},
                  {length_parameter("b_front", d.length("b_front", b)), {{2, Y, -0.5}, {3, Y, 0.5}}},
                  {length_parameter("r_right", d.length("r_right", r)), {{0, Radius}}},
                  {length_parameter("r_left", d.length("r_left", r)), {{1, Radius}}},
                  {angle_parameter("zero_right", d.number("zero_right", 0)), {{2, Zero}}},
                  {angle_parameter("zero_left", d.number("zero_left", 0)), {{3, Zero}}}};
  return t;
}

// Omni wheels on a circle of radius R at `angles`, rolling along it: counter-clockwise (turn = 1) or
// clockwise (-1). In full each has its own distance and mount.
WheelTable omni_robot(DimensionReader& d, const std::vector<double>& angles, double turn, bool full) {
  const double distance = d.length("R", 0.2), r = d.length("r", 0.05);
  WheelTable t;
  BoundParameter common{length_parameter("R", distance), {}};
  std::vector<BoundParameter> distances, radii, mounts;
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const double c = std::cos(angles[i]), s = std::sin(angles[i]);
    t.wheels.push_back(sliding_wheel(numbered_signal("wheel", i)));
    t.wheels[i].mount = angles[i] + turn * kPi / 2;
    std::vector<Binding> place;
    if (std::abs(c) > 1e-15) place.push_back({i, X, c});
    if (std::abs(s) > 1e-15) place.push_back({i, Y, s});
    common.bindings.insert(common.bindings.end(), place.begin(), place.end());
    const std::string own_radius = numbered("r", i);
    radii.push_back({length_parameter(own_radius, d.length(own_radius, r)), {{i, Radius}}});
    if (!full) continue;
    const std::string own_distance = numbered("R", i), mount = numbered("mount", i);
    distances.push_back({length_parameter(own_distance, d.length(own_distance, distance)), place});
    mounts.push_back({angle_parameter(mount, d.number(mount, 0)), {{i, Mount}}});
  }
  if (!full) distances = {common};
  for (auto* list : {&distances, &radii, &mounts})
    t.parameters.insert(t.parameters.end(), list->begin(), list->end());
  return t;
}
std::function<WheelTable(DimensionReader&)> omni3_robot(bool full) {
  return [full](DimensionReader& d) { return omni_robot(d, {-kPi / 3, kPi / 3, kPi}, -1, full); };
}
std::function<WheelTable(DimensionReader&)> omni4_robot(bool full) {
  return [full](DimensionReader& d) {
    return omni_robot(d, {kPi / 4, 3 * kPi / 4, 5 * kPi / 4, 7 * kPi / 4}, 1, full);
  };
}

// Front left, front right, rear left, rear right; lx, ly are half distances.
WheelTable mecanum_robot(DimensionReader& d) {
  constexpr std::array<double, 4> kAhead = {1, 1, -1, -1}, kLeft = {1, -1, 1, -1}, kRoller = {-1, 1, 1, -1};
  const double lx = d.length("lx", 0.2), ly = d.length("ly", 0.2), r = d.length("r", 0.05);
  WheelTable t;
  t.parameters = {{length_parameter("lx", lx), {}},
                  {length_parameter("ly", ly), {}},
                  {around("roller", "rad", d.number("roller", kPi / 4), 5 * kDegree), {}}};
  for (std::size_t i = 0; i < 4; ++i) {
    t.wheels.push_back(sliding_wheel(numbered_signal("wheel", i)));
    t.parameters[0].bindings.push_back({i, X, kAhead[i]});
    t.parameters[1].bindings.push_back({i, Y, kLeft[i]});
    t.parameters[2].bindings.push_back({i, Roller, kRoller[i]});
    const std::string name = numbered("r", i);
    t.parameters.push_back({length_parameter(name, d.length(name, r)), {{i, Radius}}});
  }
  return t;
}

// Modules on a circle of radius R, evenly, or where x1, y1, ... say.
WheelTable swerve_robot(DimensionReader& d, bool with_offsets) {
  const int count = d.count("modules", 4, 2, 32);
  const double distance = d.length("R", 0.3), r = d.length("r", 0.05);
  WheelTable t;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    const double angle = kPi * (2 * static_cast<double>(i) + 1) / count;
    const std::string nx = numbered("x", i), ny = numbered("y", i), nr = numbered("r", i),
                      nz = numbered("zero", i), nc = numbered("offset", i);
    const double x = d.number(nx, distance * std::cos(angle)), y = d.number(ny, distance * std::sin(angle));
    const double radius = d.length(nr, r), offset = d.number(nc, 0), box = kShare * std::hypot(x, y);
    t.wheels.push_back(steered_wheel(numbered_signal("wheel", i), numbered_signal("steering", i)));
    t.parameters.push_back({around(nx, "m", x, box), {{i, X}}});
    t.parameters.push_back({around(ny, "m", y, box), {{i, Y}}});
    t.parameters.push_back({length_parameter(nr, radius), {{i, Radius}}});
    t.parameters.push_back({angle_parameter(nz, d.number(nz, 0)), {{i, Zero}}});
    t.parameters.push_back({around(nc, "m", offset, with_offsets ? radius / 2 : 0), {{i, Offset}}});
  }
  return t;
}

// Front left, rear left, rear right, front right; bounds as published.
WheelTable four_wheel_steering_robot(DimensionReader& d) {
  constexpr double kPublishedShare = 0.05;
  constexpr std::array<double, 4> kAhead = {1, -1, -1, 1}, kLeft = {1, 1, -1, -1};
  const double a = d.length("a", 0.1125), b = d.length("b", 0.1125), r = d.length("r", 0.0254);
  WheelTable t;
  t.rule = TwistRule::Mean;
  const auto add = [&](const std::string& letter, WheelField field, const auto& nominal) {
    for (std::size_t i = 0; i < 4; ++i) {
      const std::string name = numbered(letter, i);
      t.parameters.push_back(
          {length_parameter(name, d.number(name, nominal(i)), kPublishedShare), {{i, field}}});
    }
  };
  for (std::size_t i = 0; i < 4; ++i)
    t.wheels.push_back(steered_wheel(numbered_signal("wheel", i), numbered_signal("steering", i)));
  add("a", X, [&](std::size_t i) { return kAhead[i] * a; });
  add("b", Y, [&](std::size_t i) { return kLeft[i] * b; });
  add("r", Radius, [&](std::size_t) { return r; });
  return t;
}

}  // namespace

const std::vector<Layout>& layouts() {
  using enum IntegrationRule;
  static const std::string kScale =
      "headings alone tell ratios of lengths only; their common scale needs positions";
  static const std::string kTurning =
      "straight lines tell the mean radius and (r_right - r_left)/b, turning on the spot (r_right + "
      "r_left)/b; one "
      "sense of turning moves r_right and b together";
  static const std::string kMount =
      "with an unknown mount of the tracked frame three combinations are free: fix one wheel or the mount";
  static const std::string kModules =
      "with an unknown mount of the tracked frame its yaw turns all modules and zeros together, its place "
      "moves all "
      "modules: fix one module or the mount";
  static const std::vector<Layout> list = {
      {"differential", "two driven wheels on one axle", Arc, {kScale, kTurning}, differential_robot},
      {"skid_steer",
       "wheels that slip sideways, as a differential robot of track slip b",
       Arc,
       {kScale, kTurning, "slip and track act only as their product: the track is not a parameter"},
       skid_steer_robot},
      {"tricycle",
       "steered and driven front wheel, passive rear axle",
       Arc,
       {kScale, "at one steering angle zero and r/wheelbase mix; both senses of turning tell them apart"},
       tricycle_robot},
      {"bicycle",
       "two rear encoders as their mean, one steering angle in front",
       Arc,
       {kScale, "at small steering angles wheelbase and gain act only as gain/wheelbase"},
       bicycle_robot},
      {"ackermann",
       "rear axle driven, both front wheels with their own steering angle",
       Arc,
       {kScale},
       ackermann_robot},
      {"omni3",
       "three omni wheels at -60, 60 and 180 degrees",
       Arc,
       {"headings alone tell r_i/R only"},
       omni3_robot(false)},
      {"omni3_full",
       "the same with distance and mount of each wheel",
       Arc,
       {"nine numbers are all that three wheels have: moving a wheel along its own direction of rolling "
        "changes "
        "nothing, so R_i is its distance on a given ray",
        kMount},
       omni3_robot(true)},
      {"omni4",
       "four omni wheels at 45, 135, 225 and 315 degrees",
       Arc,
       {"headings alone tell r_i/R only"},
       omni4_robot(false)},
      {"omni4_full",
       "the same with distance and mount of each wheel",
       Arc,
       {"moving a wheel along its own direction of rolling changes nothing, so R_i is its distance on a "
        "given ray",
        kMount},
       omni4_robot(true)},
      {"mecanum",
       "four wheels with rollers at 45 degrees",
       Arc,
       {"lx and ly act only as lx + ly (with the roller angle g: ly + lx tan g); g only through vy"},
       mecanum_robot},
      {"swerve",
       "any number of steered and driven modules, contacts at their pivots",
       Arc,
       {kModules},
       [](DimensionReader& d) { return swerve_robot(d, false); }},
      {"swerve_offset",
       "the same with contacts beside their pivots",
       Arc,
       {kModules},
       [](DimensionReader& d) { return swerve_robot(d, true); }},
      {"4wis4wid",
       "four steered and driven wheels, the published mean",
       Euler,
       {"the heading tells r_i a_i/|p_i|^2 and r_i b_i/|p_i|^2, positions r_i"},
       four_wheel_steering_robot},
  };
  return list;
}

const Layout& layout(std::string_view typed) {
  const std::string_view name = typed == "diff" ? "differential" : typed;
  std::vector<std::string> known;
  for (const Layout& l : layouts()) {
    if (l.name == name) return l;
    known.push_back(l.name);
  }
  throw std::invalid_argument(fmt::format("unknown class of robots '{}'{}", name, did_you_mean(name, known)));
}

std::string own_name(std::string_view kinematics, std::string_view parameter) {
  struct Alias {
    std::string_view kinematics, theirs, ours;
  };
  static constexpr std::array<Alias, 8> aliases = {{{"differential", "wheel_separation", "b"},
                                                    {"differential", "left_wheel_radius", "r_left"},
                                                    {"differential", "right_wheel_radius", "r_right"},
                                                    {"skid_steer", "left_wheel_radius", "r_left"},
                                                    {"skid_steer", "right_wheel_radius", "r_right"},
                                                    {"tricycle", "wheel_radius", "r"},
                                                    {"bicycle", "wheel_radius", "r"},
                                                    {"ackermann", "traction_track_width", "b"}}};
  const std::string_view name = kinematics == "diff" ? "differential" : kinematics;
  for (const Alias& alias : aliases)
    if (alias.kinematics == name && alias.theirs == parameter) return std::string(alias.ours);
  return std::string(parameter);
}

std::vector<Dimension> dimensions(const Layout& layout) {
  const Dimensions none;
  DimensionReader reader(none);
  layout.make(reader);
  return reader.asked();
}

WheelTable make_robot(const Layout& layout, const Dimensions& given) {
  DimensionReader reader(given);
  WheelTable table = layout.make(reader);
  reader.refuse_unused(layout.name);
  return table;
}

}  // namespace odobench::robots
