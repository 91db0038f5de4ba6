// What a calibration may have beyond the robot's own parameters: nuisance parameters (lags, start poses, the
// place of the tracked frame) and richer models of its wheels, by names that can be combined.
//
//   least_squares, mean   the twist of steered wheels, in the place of what the set says
//   contact_offset        one offset c of the contact beside the steering axis: -c for wheels on the left
//                         (y > 0), +c on the right; parameter `offset`, +-0.03 m
//   contact_offsets       one per steered wheel, to its left: `offset1`, ...
//   steering_zeros        one per steered wheel: `zero1`, ..., +-0.1 rad
//   steering_zero:N       of wheel N alone (from 1): `zeroN`, +-0.1 rad; all of them are hardly told apart
//                         from places of the wheels
//   steering_rate, no_steering_rate
//                         whether a wheel whose contact lies beside its axis rolls while it is steered; it
//                         does where one of the two offsets above is free
//   lever_arm             place of the tracked frame: `mount_x`, `mount_y`, +-0.1 m
//   heading_offset        its yaw: `mount_yaw`, +-0.1 rad
//   mount                 both, +-0.25 m and +-0.2 rad, as by --mount
//   time_offset           how late the reference is, `time_offset`, +-0.2 s: its signals are read that
//                         much earlier. `time_offset:speeds` shifts drives alone.
//                         `time_offset=-0.058` is held at this many seconds, for speeds with `:speeds`
//   start_pose            every drive's start (x, y, heading) is free, and eliminated: J is its minimum over
//                         them
//   anchor                every drive starts at the reference's first pose, not at the origin
//   fixed_layout          lengths and angles of the layout are held at nominal; radii are free
//   layout_scale          one factor on the places of all wheels (`layout_scale`, 1 +- 0.05), which are held
//   common_radius         one factor on all radii (`radius_factor`, 1 +- 0.05), which are held: the gear
//   speed_factor:KIND     one factor on the drives in recordings of this trajectory, or of all whose name
//                         begins so: `speed_factor`, 1 +- 0.1. No model of a robot: a competitor
//
// A number behind a colon, `contact_offset:0.02`, is the half-width of the parameters' bounds.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/robots/robot.hpp"

namespace odobench {

struct ModelTerms {
  enum class Offsets { None, Shared, Each };
  enum class Shift { All, Speeds };

  std::optional<TwistRule> twist;
  Offsets offsets = Offsets::None;
  bool steering_zeros = false, lever_arm = false, heading_offset = false, mount = false;
  bool start_pose = false, anchor = false;
  bool fixed_layout = false, layout_scale = false, common_radius = false;
  std::optional<bool> steering_rate;
  bool free_time_offset = false;
  double held_time_offset = 0;  // s
  Shift shift = Shift::All;
  std::string speed_factor_of;  // "": none
  int zero_of = 0;              // the one wheel whose zero is free, from 1; 0: none
  // Half-widths of the bounds.
  double offset_bound = 0.03, zero_bound = 0.1, lever_bound = 0.1, heading_bound = 0.1, time_bound = 0.2,
         layout_bound = 0.05, radius_bound = 0.05, factor_bound = 0.1;

  bool operator==(const ModelTerms&) const = default;
  bool any() const { return *this != ModelTerms(); }
  // Whether steering moves the contacts.
  bool rates() const { return steering_rate.value_or(offsets != Offsets::None); }
  // Whether tables of wheels alone do not express it.
  bool beyond_table() const;
  // The names that say it, in the order above: model_terms(names()) is *this.
  std::vector<std::string> names() const;
  // "contact_offset+time_offset=-0.058:speeds"; "" without any.
  std::string text() const;
};

// One line per name, for people: "contact_offset", "one offset ...".
struct ModelTermHelp {
  std::string_view name, text;
};
std::span<const ModelTermHelp> model_term_helps();

// Throws std::invalid_argument for an unknown name (with the nearest one), a bound or value that is no
// positive finite number, and names that contradict each other.
ModelTerms model_terms(const std::vector<std::string>& names);

// The robot with the parameters that its table of wheels gets, behind its own; those that are held keep their
// places with lower == nominal == upper. Throws std::invalid_argument where the robot has nothing for a name
// to act on, or has it as a parameter already.
Robot with_model(const Robot& robot, const ModelTerms& terms);

// Parameters behind those of the table, in the order mount_x, mount_y, mount_yaw, time_offset, speed_factor.
// `mount`: that of --mount.
std::vector<RobotParameter> parameters_beyond_table(const ModelTerms& terms, bool mount);

// Wheels of a robot that are steered.
bool is_steered(const Wheel& wheel);

}  // namespace odobench
