#include "datasets/import/logs/log_map.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "base/angle.hpp"
#include "base/json_node.hpp"
#include "base/names.hpp"
#include "base/text.hpp"
#include "datasets/import/csv/csv_map.hpp"
#include "datasets/import/logs/map_signals.hpp"
#include "datasets/native/robot_json.hpp"

namespace odobench::log_import {
namespace {

using csv_import::angle_scale;
using csv_import::length_scale;

constexpr double kLongestOffset = 4e9;  // s

double positive(const JsonNode& node, double most) {
  const double value = node.number();
  if (!(value > 0) || !(value <= most))
    node.fail(fmt::format("{}", value), fmt::format("a number above 0, at most {}", most));
  return value;
}

void read_format(const JsonNode& node, LogOptions& format) {
  csv_import::allow_only(node, {"separator", "decimal", "comment", "header_rows", "encoding"});
  format.separator = node.text_or_empty("separator");
  format.decimal = node.text_or_empty("decimal");
  format.comment = node.text_or_empty("comment");
  format.encoding = node.text_or_empty("encoding");
  if (node.has("header_rows")) format.header_rows = node.at("header_rows").small_integer();
}

MappedSource read_source(const JsonNode& node, const std::string& name) {
  MappedSource source;
  source.name = name;
  if (!node.is_object()) {
    source.topic = node.text();
    return source;
  }
  csv_import::allow_only(node,
                         {"topic", "struct", "prefix", "files", "format", "time", "time_unit", "offset_s"});
  int given = 0;
  for (const char* key : {"topic", "struct", "prefix"})
    if (node.has(key)) {
      source.topic = node.at(key).text();
      ++given;
    }
  if (given > 1) node.fail("two of topic, struct and prefix", "one of them");
  source.files = node.text_or_empty("files");
  source.time = node.text_or_empty("time");
  source.time_unit = node.text_or_empty("time_unit");
  if (node.has("format")) read_format(node.at("format"), source.format);
  if (!node.has("offset_s")) return source;
  const JsonNode offset = node.at("offset_s");
  // A text is told from a number by what reading it says.
  bool text = true;
  try {
    (void)offset.text();
  } catch (const DataError&) {
    text = false;
  }
  if (!text) {
    source.offset_s = offset.number();
    if (!(std::abs(*source.offset_s) <= kLongestOffset))
      offset.fail(fmt::format("{}", *source.offset_s), fmt::format("at most {:g} s", kLongestOffset));
  } else if (offset.text() == "estimate")
    source.offset_s.reset();
  else
    offset.fail('"' + shown(offset.text()) + '"', "a number of seconds or \"estimate\"");
  return source;
}

void read_sources(const JsonNode& node, LogMap& map) {
  for (const std::string& name : node.keys()) map.sources.push_back(read_source(node.at(name), name));
  if (map.sources.empty()) node.fail("none", "at least one source");
}

MappedField read_reference(const JsonNode& node, const std::string& target, const LogMap& map) {
  const bool angle = target == "reference.heading";
  csv_import::allow_only(node, {"source", "field", "quaternion", "unit", "sign", "offset"});
  MappedField field = read_field(node, target, map);
  const std::string unit = node.has("unit") ? node.at("unit").text() : angle ? "rad" : "m";
  const std::optional<double> scale = angle ? angle_scale(unit) : length_scale(unit);
  if (!scale)
    node.at("unit").fail('"' + shown(unit) + '"', angle ? "\"rad\" or \"deg\"" : "\"m\", \"cm\" or \"mm\"");
  field.scale *= *scale;
  if (!field.quaternion.empty() && !angle) node.at("quaternion").fail("one", "it of a heading only");
  return field;
}

// Nothing but a gyro: it is the reference of headings.
bool take_gyro(LogMap& map) {
  for (MappedField& field : map.others) {
    if (field.target != "gyro.z") continue;
    field.optional = false;
    map.reference = {field, field, field};
    map.kind = ReferenceKind::Headings;
    return true;
  }
  return false;
}

void read_signals(const JsonNode& node, LogMap& map, MapUse use) {
  SignalReader signals(node, map);
  for (const std::string& key : node.keys()) {
    const JsonNode one = node.at(key);
    if (key == "reference.x" || key == "reference.y" || key == "reference.heading" ||
        key == "reference.theta")
      map.reference.push_back(read_reference(one, key == "reference.theta" ? "reference.heading" : key, map));
    else if (key.starts_with("gyro.") || key.starts_with("accel.") || key.starts_with("camera."))
      map.others.push_back(read_other(one, key, map));
    else
      signals.take(key);
  }
  signals.finish();
  if (!map.poses.empty()) {
    if (!map.reference.empty()) node.fail("a reference beside end poses", "one of them");
    return;
  }
  if (use == MapUse::Filter && map.reference.empty()) return;
  if (map.reference.empty() && take_gyro(map)) return;
  for (const char* target : {"reference.x", "reference.y", "reference.heading"})
    if (std::none_of(map.reference.begin(), map.reference.end(),
                     [&](const MappedField& f) { return f.target == target; }))
      node.fail(fmt::format("no \"{}\"", target),
                "where the robot was: reference.x, reference.y and reference.heading, a table of end poses "
                "(\"poses\"), or gyro.z for its turns alone");
  std::sort(map.reference.begin(), map.reference.end(), [](const MappedField& a, const MappedField& b) {
    const auto place = [](const MappedField& f) {
      return f.target == "reference.heading" ? 2 : f.target.back() - 'x';
    };
    return place(a) < place(b);
  });
  for (const MappedField& field : map.reference)
    if (field.source != map.reference.front().source)
      node.at(field.target)
          .fail(fmt::format("the source \"{}\"", shown(field.source)),
                "the same source for x, y and heading");
}

// x, y [m] and yaw of a frame in the robot's.
void read_frame(const JsonNode& node, double& x, double& y, double& yaw) {
  csv_import::allow_only(node, {"x", "y", "yaw", "yaw_deg"});
  if (node.has("x")) x = node.at("x").number();
  if (node.has("y")) y = node.at("y").number();
  if (node.has("yaw") && node.has("yaw_deg")) node.fail("yaw and yaw_deg", "one of them");
  if (node.has("yaw")) yaw = node.at("yaw").number();
  if (node.has("yaw_deg")) yaw = node.at("yaw_deg").number() * kDegree;
}

void read_mount(const JsonNode& node, LogMap& map) {
  if (node.is_object()) return read_frame(node, map.mount_x, map.mount_y, map.mount_yaw);
  if (node.text() != "estimate") node.fail('"' + shown(node.text()) + '"', "numbers or \"estimate\"");
  map.estimate_mount = true;
}

void read_drives(const JsonNode& node, LogMap& map) {
  csv_import::allow_only(node, {"split", "standstill_s", "names", "marks"});
  if (node.has("split")) {
    const std::string split = node.at("split").text();
    if (split != "none" && split != "standstill" && split != "marks")
      node.at("split").fail('"' + shown(split) + '"', "\"none\", \"standstill\" or \"marks\"");
    map.split = split == "none" ? Split::None : split == "marks" ? Split::Marks : Split::Standstill;
  }
  if (node.has("standstill_s")) map.standstill_s = positive(node.at("standstill_s"), 3600);
  if (node.has("names"))
    for (const JsonNode& name : node.at("names").elements()) map.names.push_back(name.text());
  if (node.has("marks") != (map.split == Split::Marks))
    node.fail(node.has("marks") ? "marks" : "no marks", "\"split\": \"marks\" together with \"marks\"");
  if (!node.has("marks")) return;
  for (const JsonNode& mark : node.at("marks").elements()) {
    csv_import::allow_only(mark, {"from_s", "to_s", "name"});
    map.marks.push_back({mark.at("from_s").number(), mark.at("to_s").number(), mark.text_or_empty("name")});
    if (!(map.marks.back().from_s < map.marks.back().to_s))
      mark.fail("from_s at or after to_s", "from before to");
  }
}

void read_limits(const JsonNode& node, LogMap& map) {
  csv_import::allow_only(node, {"max_gap_s", "max_wheel_gap_s", "min_drive_s"});
  if (node.has("max_gap_s")) map.reference_gap_s = positive(node.at("max_gap_s"), 1e6);
  map.wheel_gap_s = node.has("max_wheel_gap_s") ? positive(node.at("max_wheel_gap_s"), 1e6)
                                                : std::max(map.wheel_gap_s, map.reference_gap_s / 2);
  if (node.has("min_drive_s")) map.shortest_drive_s = positive(node.at("min_drive_s"), 1e6);
}

// "drifting" of another odometry.
void read_kind(const JsonNode& root, LogMap& map) {
  if (map.kind == ReferenceKind::Headings && root.has("mount"))
    root.at("mount").fail("a mount", "none: a gyro turns as the robot does, wherever it sits");
  if (!root.has("reference")) return;
  const std::string name = root.at("reference").text();
  const bool drifts = name == name_of(ReferenceKind::Drifting);
  if (!drifts && name != name_of(map.kind))
    root.at("reference")
        .fail('"' + shown(name) + '"',
              fmt::format("\"drifting\", or \"{}\" as by default", name_of(map.kind)));
  if (drifts && (map.reference.empty() || map.kind == ReferenceKind::Headings))
    root.at("reference").fail("\"drifting\"", "it of poses only");
  if (drifts) map.kind = ReferenceKind::Drifting;
}

// What needs to know where the robot was in between.
void refuse_with_poses(const JsonNode& root, const LogMap& map) {
  if (root.has("mount"))
    root.at("mount").fail("a mount", "none: end poses are those of the robot's own frame");
  for (const MappedSource& source : map.sources)
    if (!source.offset_s)
      root.at("sources")
          .at(source.name)
          .at("offset_s")
          .fail("\"estimate\"", "a number: there is no reference");
}

}  // namespace

const MappedSource& source_of(const LogMap& map, const std::string& name) {
  return *std::find_if(map.sources.begin(), map.sources.end(),
                       [&](const MappedSource& s) { return s.name == name; });
}

LogMap parse_log_map(std::string_view text, const std::string& file, const std::filesystem::path& poses,
                     MapUse use) {
  const JsonNode root = JsonNode::parse(text, file);
  csv_import::check_map_schema(
      root, {"schema", "schema_version", "name", "description", "source", "licence", "robot", "sources",
             "signals", "poses", "reference", "mount", "camera_mount", "drives", "limits"});
  LogMap map;
  map.file = file;
  map.name = root.at("name").text();
  if (map.name.empty()) root.at("name").fail("an empty text", "a name");
  map.description = root.text_or_empty("description");
  map.source = root.text_or_empty("source");
  map.licence = root.text_or_empty("licence");
  map.robot = read_robot(root.at("robot"), 2);
  read_sources(root.at("sources"), map);
  if (root.has("poses")) map.poses = std::filesystem::path(file).parent_path() / root.at("poses").text();
  if (!poses.empty()) map.poses = poses;
  if (!map.poses.empty()) refuse_with_poses(root, map);
  if (root.has("limits")) read_limits(root.at("limits"), map);
  read_signals(root.at("signals"), map, use);
  read_kind(root, map);
  if (root.has("mount")) read_mount(root.at("mount"), map);
  if (root.has("camera_mount"))
    read_frame(root.at("camera_mount"), map.camera_x, map.camera_y, map.camera_yaw);
  if (root.has("drives")) read_drives(root.at("drives"), map);
  return map;
}

}  // namespace odobench::log_import
