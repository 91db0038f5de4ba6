// What the name of a column says of it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace odobench {

enum class Meaning { Unknown, Time, X, Y, Heading, Wheel, Steering };

struct ColumnName {
  std::string name;
  Meaning meaning = Meaning::Unknown;
  std::string unit;       // as the map writes it: "rad/s", "deg", "mm", "ns", "count"; "" where it says none
  std::string which;      // of a wheel: "left", "right", "1"; "" where there is one
  std::string quadrant;   // of a wheel that names it: "FL" of front_left, "RR" of rr; else ""
  bool odometry = false;  // a pose of the robot's own
};

// "left_rad_s", "wheel_speed.right [rpm]", "Time (ms)", "gt_x", "steer_1_deg".
ColumnName column_name(std::string_view name);

// The class of robots whose wheels are called so; "" where they fit several or none.
std::string class_of_wheels(std::vector<std::string> driven, const std::vector<std::string>& steered);

}  // namespace odobench
