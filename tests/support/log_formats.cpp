#include "tests/support/log_formats.hpp"

#include <cmath>

#include "tests/support/binary_logs.hpp"
#include "tests/support/data/drive_log.hpp"
#include "tests/support/log_writers.hpp"

namespace odobench::testing {
namespace {

using Examples = std::vector<std::string>;

constexpr const char* kRobot = R"("schema": "odobench-import", "schema_version": 1, "name": "mine",
 "robot": {"name": "mine", "kinematics": "diff", "parameters": [{"name": "b", "nominal": 0.4},
   {"name": "r_right", "nominal": 0.05}, {"name": "r_left", "nominal": 0.05}]},
 "limits": {"min_drive_s": 0.05, "max_gap_s": 0.5},)";

// Of what small_log() holds.
const std::string kRosMap = std::string("{") + kRobot + R"(
 "sources": {"ticks": {"topic": "/ticks"}, "tf": {"topic": "/tf", "offset_s": 0.001}, "joints": {"topic": "/joints"}},
 "signals": {"wheel_angle.left": {"source": "ticks", "field": "left", "unit": "count", "per_turn": 100, "wrap": 65536},
   "wheel_speed.left": {"source": "joints", "field": "velocity[name=left]", "unit": "rad/s"},
   "wheel_angle.right": {"source": "ticks", "field": "right", "unit": "count", "per_turn": 100, "sign": -1},
   "reference.x": {"source": "tf", "field": "transforms[header.frame_id=odom,child_frame_id=base].transform.translation.x"},
   "reference.y": {"source": "tf", "field": "transforms[header.frame_id=odom,child_frame_id=base].transform.translation.y"},
   "reference.heading": {"source": "tf", "quaternion": "transforms[header.frame_id=odom,child_frame_id=base].transform.rotation"}},
 "mount": {"x": 0.01, "yaw_deg": 1}, "drives": {"split": "standstill", "standstill_s": 0.5}})";

// Of arrays: ticks (t, count), mocap (t, pose).
const std::string kArrayMap = std::string("{") + kRobot + R"(
 "sources": {"ticks": {"topic": "ticks", "time": "t"}, "mocap": {"topic": "mocap"}},
 "signals": {"wheel_angle.left": {"source": "ticks", "field": "count[0]", "unit": "count", "per_turn": 100},
   "wheel_angle.right": {"source": "ticks", "field": "count[1]", "unit": "count", "per_turn": 100},
   "reference.x": {"source": "mocap", "field": "pose[0]"}, "reference.y": {"source": "mocap", "field": "pose[1]"},
   "reference.heading": {"source": "mocap", "field": "pose[2]"}}})";

const std::string kLinesMap = std::string("{") + kRobot + R"(
 "sources": {"encoders": {"topic": "encoders"}, "pose": {"topic": "pose"}},
 "signals": {"wheel_angle.left": {"source": "encoders", "field": "data[0]", "unit": "count", "per_turn": 100},
   "wheel_angle.right": {"source": "encoders", "field": "data[1]", "unit": "count", "per_turn": 100},
   "reference.x": {"source": "pose", "field": "position.x"}, "reference.y": {"source": "pose", "field": "position.y"},
   "reference.heading": {"source": "pose", "field": "yaw"}}})";

const std::string kTableMap = std::string("{") + kRobot + R"(
 "sources": {"table": {"time_unit": "s"}},
 "signals": {"wheel_speed.left": {"field": "links [1/min]", "unit": "rpm"},
   "wheel_speed.right": {"field": "rechts [1/min]", "unit": "rpm"},
   "reference.x": {"field": "x [m]"}, "reference.y": {"field": "y [m]"}, "reference.heading": {"field": "yaw"}}})";

constexpr const char* kTable =
    "time [s];links [1/min];rechts [1/min];x [m];y "
    "[m];yaw\n0,01;60;-60;;;\n0,02;;;1;-0,5;0,1\n0,03;60,5;-6e1;;;\n"
    "0,04;;;1,0;-0,5;0,11\n0,05;61;-60;;;\n0,06;;;1,0;-0,5;0,12\n0,09;61;-60;;;\n0,1;;;1,1;-0,5;0,12\n0,13;6;"
    "-6;;;\n0,15;;;1,1;-0,5;0,1\n";

std::string lines_log() {
  std::string text;
  for (int k = 0; k < 12; ++k) {
    const std::string t = std::to_string(1'760'000'000'000'000 + k * 50'000);
    text += R"({"topic":"encoders","t":)" + t + ",\"data\":[" + std::to_string(3 * k) + "," +
            std::to_string(5 * k) + "]}\n";
    text += R"({"topic":"pose","t":)" + t + R"(,"position":{"x":)" + std::to_string(0.1 * k) +
            R"(,"y":0},"yaw":0.0)" + std::to_string(k) + "}\n";
  }
  return text;
}

struct Arrays {
  std::vector<std::int64_t> t;
  std::vector<std::int32_t> count;  // by rows
  std::vector<double> pose;
  Arrays() {
    for (int k = 0; k < 12; ++k) {
      t.push_back(1'760'000'000'000'000'000 + k * 50'000'000LL);
      count.insert(count.end(), {3 * k, 5 * k});
      pose.insert(pose.end(), {0.1 * k, 0.0, 0.01 * k});
    }
  }
};

std::string npz_log() {
  const Arrays a;
  return zip_file({{"ticks_t.npy", npy_file("<i8", "(12,)", bytes_of_numbers(a.t))},
                   {"ticks_count.npy", npy_file("<i4", "(12, 2)", bytes_of_numbers(a.count))},
                   {"mocap_t.npy", npy_file("<i8", "(12,)", bytes_of_numbers(a.t))},
                   {"mocap_pose.npy", npy_file("<f8", "(12, 3)", bytes_of_numbers(a.pose))}},
                  {.deflate = true});
}

std::string mat_log() {
  const Arrays a;
  std::vector<std::int32_t> count;  // by columns
  for (std::size_t column = 0; column < 2; ++column)
    for (std::size_t k = 0; k < a.t.size(); ++k) count.push_back(a.count[2 * k + column]);
  std::vector<double> pose;
  for (std::size_t column = 0; column < 3; ++column)
    for (std::size_t k = 0; k < a.t.size(); ++k) pose.push_back(a.pose[3 * k + column]);
  const std::string t = mat_array("", 14, {12, 1}, mat_element(12, bytes_of_numbers(a.t)));
  const std::string ticks = mat_struct(
      "ticks", {{"t", t}, {"count", mat_array("", 12, {12, 2}, mat_element(5, bytes_of_numbers(count)))}});
  const std::string mocap = mat_struct(
      "mocap", {{"t", t}, {"pose", mat_array("", 6, {12, 3}, mat_element(9, bytes_of_numbers(pose)))}});
  return mat_file({ticks, mocap});
}

std::string db3_log() {
  const TemporaryFolder folder;
  write_rosbag2(folder / "log.db3", small_log(RosEncoding::Cdr));
  return content(folder / "log.db3");
}

// Looked at, proposed for, and imported by the map.
std::vector<Words> read_log(const std::string& log, const std::string& name, const std::string& map,
                            const TemporaryFolder& folder) {
  const std::string file = folder.file(name, log);
  return {{"import", file, "--map=" + folder.file("map.json", map),
           "--out=" + (folder / "out/set.json").string(), "--keep-cut", "--overwrite"},
          {"import", file, "--show"},
          {"import", file, "--propose"}};
}

Format log_format(const std::string& name, std::function<Examples()> examples, const std::string& map) {
  Format format{name, std::move(examples),
                [name, map](const std::string& bytes, const TemporaryFolder& folder) {
                  return read_log(bytes, name + ".log", map, folder);
                }};
  format.binary = true;
  return format;
}

}  // namespace

std::vector<Format> log_formats_read() {
  std::vector<Format> all;
  all.push_back(log_format(
      "bag",
      [] {
        return Examples{bag_bytes(small_log(RosEncoding::Ros1), "none"),
                        bag_bytes(small_log(RosEncoding::Ros1), "lz4")};
      },
      kRosMap));
  all.push_back(log_format(
      "mcap",
      [] {
        McapOptions zstd;
        zstd.compression = "zstd";
        return Examples{mcap_bytes(small_log(RosEncoding::Cdr)),
                        mcap_bytes(small_log(RosEncoding::Cdr), zstd)};
      },
      kRosMap));
  all.push_back(log_format(
      "db3", [] { return Examples{db3_log()}; }, kRosMap));
  all.push_back(log_format(
      "npz", [] { return Examples{npz_log()}; }, kArrayMap));
  all.push_back(log_format(
      "mat", [] { return Examples{mat_log()}; }, kArrayMap));
  all.push_back(log_format(
      "lines", [] { return Examples{lines_log()}; }, kLinesMap));
  all.push_back(log_format(
      "table", [] { return Examples{kTable}; }, kTableMap));
  Format map{"log_map", [] { return Examples{kRosMap}; },
             [](const std::string& bytes, const TemporaryFolder& folder) {
               static const std::string log = mcap_bytes(small_log(RosEncoding::Cdr));
               std::vector<Words> commands = read_log(log, "log.mcap", bytes, folder);
               commands.resize(1);
               return commands;
             }};
  all.push_back(std::move(map));
  return all;
}

}  // namespace odobench::testing
