// map.json of a log: which of its fields are what signal of which robot (docs/import.md).
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"
#include "datasets/dataset.hpp"
#include "datasets/logs/log_file.hpp"
#include "datasets/native/signal_format.hpp"
#include "datasets/robots/robot.hpp"

namespace odobench::log_import {

// Where rows of a log come from, and by which clock.
struct MappedSource {
  std::string name;   // in the map
  std::string topic;  // LogSource::name: a topic, a struct, a prefix; "" of a table
  std::string files;  // a pattern of names, of the logs that are given; "" all of them
  std::string time, time_unit;
  // By how much its clock runs ahead of the robot's [s]: stamps are lessened by it. Nothing: to be estimated.
  std::optional<double> offset_s = 0.0;
  LogOptions format;
};

// A field of a source and how it becomes a value: sign * (raw + add) * scale, in SI.
struct MappedField {
  std::string target;      // "reference.x", "wheel.left", "gyro.z"
  std::string source;      // MappedSource::name
  std::string field;       // path of the number
  std::string quaternion;  // path of x, y, z, w, whose yaw it is; instead of a field
  double scale = 1, add = 0;
  bool optional = false;  // a log without it is welcome
};

struct MappedSignal {
  MappedField at;         // scale and sign stand in the format
  SignalFormat format;    // of the robot's signal: position, increment, speed, travel or angle
  double half_count = 0;  // added to an angle in counts, which encoders round down
};

enum class Split { None, Standstill, Marks };

struct Mark {
  double from_s = 0, to_s = 0;  // since the first stamp of the log
  std::string name;
};

struct LogMap {
  std::string file;  // for messages
  std::string name, description, source, licence;
  Robot robot;
  std::vector<MappedSource> sources;
  // x, y, heading; none where end poses were measured; of headings the gyro, three times.
  std::vector<MappedField> reference;
  ReferenceKind kind = ReferenceKind::Poses;
  std::filesystem::path poses;        // table of such (end_poses.hpp), "" without
  std::vector<MappedSignal> signals;  // those of the robot, in its order
  std::vector<MappedField> others;    // gyro.z, accel.x, accel.y, camera.*: optional ones may be missing
  double mount_x = 0, mount_y = 0, mount_yaw = 0;  // of the tracked frame in the robot's; m, rad
  bool estimate_mount = false;
  double camera_x = 0, camera_y = 0, camera_yaw = 0;  // of the camera in the robot's frame; m, rad
  Split split = Split::None;
  double standstill_s = 3;  // that ends a drive
  std::vector<Mark> marks;
  std::vector<std::string> names;  // of the drives, in their order: "square_2" is repetition 2 of "square"
  double reference_gap_s = 0.2, wheel_gap_s = 0.1;  // longer ones split a drive
  double shortest_drive_s = 1;                      // shorter parts are left out, counted
};

const MappedSource& source_of(const LogMap& map, const std::string& name);

// What a map is read for: a filter needs no reference, and knows nothing of end poses.
enum class MapUse { Recordings, Filter };

// Throws DataError "file: /place: found ..., expected ..." for broken JSON, unknown keys and names (with the
// nearest known one), null, wrong units, a robot that read_robot() refuses, sources that do not exist,
// signals that the robot has not or that are missing. A map without reference has "poses", a file beside it
// (`poses` goes before that one), or a gyro whose integral is the reference: ReferenceKind::Headings.
LogMap parse_log_map(std::string_view text, const std::string& file, const std::filesystem::path& poses = {},
                     MapUse use = MapUse::Recordings);

}  // namespace odobench::log_import
