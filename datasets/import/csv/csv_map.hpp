// map.json: which columns of a user's own CSV files are what (docs/import.md).
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"
#include "base/json_node.hpp"
#include "datasets/native/signal_format.hpp"
#include "datasets/robots/robot.hpp"

namespace odobench::csv_import {

inline constexpr const char* kMapSchema = "odobench-import";
inline constexpr int kMapSchemaVersion = 1;

struct MappedColumn {
  std::string column;
  std::string place;  // in the map, "/reference/x/column"
  double scale = 1;   // to m or rad
};

struct MappedSignal {
  MappedColumn at;
  SignalFormat format;
};

// What a file is a drive of, where its name does not say it.
struct NamedDrive {
  std::string trajectory;
  std::optional<int> repetition;
};

struct CsvMap {
  std::string file;  // for messages
  std::string name, description, source, licence;
  Robot robot;
  MappedColumn time;
  int time_digits = 9;  // the unit is 10^digits ns
  MappedColumn x, y, theta;
  std::vector<MappedSignal> signals;         // those of the robot, in its order
  std::vector<std::string> columns;          // of files without a header line
  char separator = ',';                      // of those
  std::map<std::string, NamedDrive> drives;  // by name of the file, with or without its extension
};

// The unit of a column of time as digits for decimal_nanoseconds(); nothing where it is none.
std::optional<int> time_digits(std::string_view unit);
// m, cm, mm or rad, deg in SI.
std::optional<double> length_scale(std::string_view unit);
std::optional<double> angle_scale(std::string_view unit);

// What a robot needs: the drives of its wheels, then steering angles.
struct NeededSignal {
  std::string name;
  bool steering = false;
};
std::vector<NeededSignal> needed_signals(const Robot& robot);

// JsonNode::allow_only() with the nearest key.
void allow_only(const JsonNode& node, const std::vector<std::string>& known);
// Schema and version of a map, tables' or logs', and no other keys than these.
void check_map_schema(const JsonNode& root, const std::vector<std::string>& known);

// Throws DataError "file: /place: found ..., expected ..." for broken JSON, unknown keys (with the nearest
// known one), null and other types, wrong units, a robot that read_robot() refuses, signals that the robot
// has not or that are missing, a steering signal that is no angle, a drive that is one, speeds beside
// increments.
CsvMap parse_csv_map(std::string_view text, const std::string& file);

}  // namespace odobench::csv_import
