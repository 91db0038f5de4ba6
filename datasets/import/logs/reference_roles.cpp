#include "datasets/import/logs/reference_roles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

#include "base/text.hpp"
#include "datasets/csv/column_name.hpp"

namespace odobench::log_import {
namespace {

struct Pose {
  std::vector<Role> roles;
  int rank = 100;
  std::string why;
  bool drifts = false;
};

constexpr const char* kDrifts =
    ": another odometry, by its name: it drifts, so that segments of the way are to be compared "
    "(--cost=segments), not whole drives";

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

bool names_any(const std::string& text, std::initializer_list<const char*> words) {
  const std::string small = lower(text);
  return std::any_of(words.begin(), words.end(),
                     [&](const char* word) { return small.find(word) != std::string::npos; });
}

bool is_capture(const std::string& name) {
  return names_any(name, {"mocap", "vicon", "optitrack", "qualisys", "vrpn", "natnet", "ground_truth",
                          "groundtruth", "gt", "rigid_body", "motion_capture", "tracker"});
}

// Odometry that knows nothing of the wheels: its errors grow with the way.
bool is_other_odometry(const std::string& name) {
  return names_any(name,
                   {"visual",     "vio",     "vslam",     "stereo", "orb_slam", "orbslam",      "rtabmap",
                    "openvins",   "vins",    "realsense", "t265",   "zed",      "lidar_odom",   "laser_odom",
                    "scan_match", "lio_sam", "fast_lio",  "loam",   "kiss_icp", "cartographer", "slam"});
}

std::vector<Role> pose_below(std::size_t source, const std::string& place, const std::string& turn) {
  return {{"x", source, place + ".x", "", "", "m"},
          {"y", source, place + ".y", "", "", "m"},
          {"heading", source, "", turn, "", "rad"}};
}

bool ends_with_type(const LogSource& source, const char* type) {
  return source.type == type || source.type.ends_with(std::string("/") + type);
}

// Of messages; the rank grows with doubt.
Pose message_pose(const LogSource& source, std::size_t i) {
  const std::string name = shown(source.name);
  if (names_any(source.name, {"amcl"}))
    return {pose_below(i, "pose.pose.position", "pose.pose.orientation"), 8,
            name + ": a localisation that uses the wheels itself, 5 cm at best: a last choice"};
  const bool capture = is_capture(source.name);
  if (!capture && is_other_odometry(source.name)) {
    const std::string place = ends_with_type(source, "PoseStamped") ? "pose" : "pose.pose";
    if (place == "pose.pose" && !ends_with_type(source, "Odometry") &&
        !ends_with_type(source, "PoseWithCovarianceStamped"))
      return {};
    return {pose_below(i, place + ".position", place + ".orientation"), 3, name + kDrifts, true};
  }
  const int doubt = capture ? 0 : 4;
  const std::string why = name + (capture ? ": a pose, by its name of motion capture" : ": a pose");
  if (ends_with_type(source, "PoseStamped"))
    return {pose_below(i, "pose.position", "pose.orientation"), doubt, why};
  if (ends_with_type(source, "PoseWithCovarianceStamped"))
    return {pose_below(i, "pose.pose.position", "pose.pose.orientation"), doubt + 1, why};
  if (ends_with_type(source, "TransformStamped"))
    return {pose_below(i, "transform.translation", "transform.rotation"), doubt, why};
  if (ends_with_type(source, "Odometry") && capture)
    return {pose_below(i, "pose.pose.position", "pose.pose.orientation"), 1, why};
  if (ends_with_type(source, "TFMessage")) {
    for (const LogField& field : source.fields) {
      const std::size_t end = field.path.find("].transform.translation.x");
      if (end == std::string::npos || !is_capture(field.path)) continue;
      const std::string element = field.path.substr(0, end + 1) + ".transform";
      return {pose_below(i, element + ".translation", element + ".rotation"), 2,
              name + ": " + shown(element)};
    }
  }
  return {};
}

// The x of an orientation or of a velocity is no place.
bool no_place(const std::string& path) {
  return names_any(path, {"orientation", "rotation", "quaternion", "angular", "accel", "veloc", "twist",
                          "covariance", "magnet", "force", "torque"});
}

// Columns, members of a struct, keys of JSON.
Pose named_pose(const LogSource& source, std::size_t i) {
  std::array<std::optional<Role>, 3> parts;
  std::string quaternion;
  for (const LogField& field : source.fields) {
    if (field.type == "quaternion") quaternion = field.path;
    if (field.type == "string" || field.type == "text" || field.type == "time") continue;
    const ColumnName name = column_name(field.path);
    const int part = name.meaning == Meaning::X         ? 0
                     : name.meaning == Meaning::Y       ? 1
                     : name.meaning == Meaning::Heading ? 2
                                                        : -1;
    if (part < 0 || name.odometry || parts[static_cast<std::size_t>(part)]) continue;
    if (part < 2 && no_place(field.path)) continue;
    static constexpr std::array<const char*, 3> targets = {"x", "y", "heading"};
    const bool length = name.unit == "m" || name.unit == "mm" || name.unit == "cm";
    const std::string usual = part == 2 ? "rad" : "m";
    const bool fits = part == 2 ? name.unit == "rad" || name.unit == "deg" : length;
    parts[static_cast<std::size_t>(part)] =
        Role{targets[static_cast<std::size_t>(part)], i, field.path, "", "", fits ? name.unit : usual};
  }
  const auto has = [&](const char* path) {
    return std::any_of(source.fields.begin(), source.fields.end(),
                       [&](const LogField& f) { return f.path == path; });
  };
  if (!parts[2] && has("qx") && has("qw")) parts[2] = Role{"heading", i, "", "q", "", "rad"};
  if (!parts[2] && !quaternion.empty()) parts[2] = Role{"heading", i, "", quaternion, "", "rad"};
  if (!parts[0] || !parts[1] || !parts[2]) return {};
  const bool trajectory = source.type.find("trajectory") != std::string::npos;
  return {{*parts[0], *parts[1], *parts[2]},
          trajectory                ? 1
          : is_capture(source.name) ? 2
                                    : 3,
          fmt::format("{}: {}, {}, {}", source.name.empty() ? "the table" : shown(source.name),
                      shown(parts[0]->field), shown(parts[1]->field),
                      shown(parts[2]->field.empty() ? parts[2]->quaternion : parts[2]->field))};
}

// "pose[0]", "pose[1]", "pose[2]": x, y, yaw in this order.
Pose array_pose(const LogSource& source, std::size_t i) {
  for (const LogField& field : source.fields) {
    if (!field.path.ends_with("[0]") || !names_any(field.path, {"pose", "mocap", "xyt", "state"})) continue;
    const std::string array = field.path.substr(0, field.path.size() - 3);
    const auto has = [&](int k) {
      const std::string path = fmt::format("{}[{}]", array, k);
      return std::any_of(source.fields.begin(), source.fields.end(),
                         [&](const LogField& f) { return f.path == path; });
    };
    if (has(1) && has(2) && !has(3))
      return {{{"x", i, array + "[0]", "", "", "m"},
               {"y", i, array + "[1]", "", "", "m"},
               {"heading", i, array + "[2]", "", "", "rad"}},
              4,
              fmt::format("{}: three columns of {}, taken as x, y, yaw", shown(source.name), shown(array))};
  }
  return {};
}

bool own_odometry(const LogSource& source) {
  return (ends_with_type(source, "Odometry") && !is_capture(source.name) &&
          !is_other_odometry(source.name)) ||
         (ends_with_type(source, "TFMessage") &&
          std::any_of(source.fields.begin(), source.fields.end(),
                      [](const LogField& f) { return f.path.find("odom") != std::string::npos; }));
}

}  // namespace

void find_reference(const std::vector<SurveyedSource>& sources, Roles& roles) {
  Pose best;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const LogSource& source = sources[i].source;
    if (!source.unreadable.empty()) continue;
    if (own_odometry(source))
      roles.reasons.push_back(shown(source.name) + ": the robot's own odometry is no reference: not offered");
    std::vector<Pose> poses{message_pose(source, i), named_pose(source, i), array_pose(source, i)};
    // A file has no topic: its own name tells.
    const std::string file = sources[i].file.stem().string();
    if (source.name.empty() && is_other_odometry(file) && !is_capture(file) && !poses[1].roles.empty()) {
      poses[1].drifts = true;
      poses[1].why = shown(file) + kDrifts;
    }
    for (Pose& pose : poses)
      if (!pose.roles.empty() && !own_odometry(source) && pose.rank < best.rank) best = std::move(pose);
  }
  roles.reference = best.roles;
  roles.drifts = best.drifts;
  roles.reasons.push_back("reference: " + (best.roles.empty() ? std::string("none found: null") : best.why));
}

}  // namespace odobench::log_import
