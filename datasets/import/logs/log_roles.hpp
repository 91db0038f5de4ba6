// What the fields of a log seem to be, by names and types alone.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/stop.hpp"
#include "datasets/logs/log_file.hpp"

namespace odobench::log_import {

struct SurveyedSource {
  std::filesystem::path file;  // the first of those that have the same sources and fields
  std::string files;           // pattern of all of those, "" where there is one log in all
  LogSource source;
};

// Logs with the same sources and fields are looked at once, as drives of one kind.
std::vector<SurveyedSource> survey_logs(const std::vector<std::filesystem::path>& logs,
                                        const LogOptions& options, const Stop& stop);

// A field, or the quaternion below a path, in one of the sources.
struct Role {
  std::string which;  // of a wheel: "left", "1", "" where there is one; of a reference "x", "y", "heading"
  std::size_t source = 0;  // number of the surveyed source
  std::string field, quaternion;
  std::string kind;           // of a wheel: "position", "speed", "travel"
  std::string unit;           // "" where nothing tells it
  std::string quadrant = {};  // of a wheel whose name says it: "FL", "FR", "RL", "RR"
};

struct Roles {
  std::string kinematics;  // a class of robots, "" where the wheels fit several or none
  std::vector<Role> wheels, steering;
  std::vector<Role> reference;  // x, y, heading, or empty
  bool drifts = false;          // it is another odometry, visual or of a laser scanner
  std::vector<Role> gyro;       // one or none
  bool by_place = false;        // left and right are guessed from the order of an array or of columns
  std::vector<std::string> reasons;
};

// Wheels: joints of JointState messages, else fields with names of wheels or arrays of two; angles go before
// counts, counts before speeds, speeds before travel. Reference: poses whose topic names motion capture, an
// odometry whose topic or file names cameras or laser scanners, other poses, trajectories, columns x, y, yaw;
// never the robot's own odometry. `robot`: the class, where it is known ("": by the wheels); its wheels are
// then told by number or, where each stands in a quadrant of its own, by names like front_left.
Roles find_roles(const std::vector<SurveyedSource>& sources, const std::string& robot = "");

}  // namespace odobench::log_import
