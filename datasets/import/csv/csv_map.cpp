#include "datasets/import/csv/csv_map.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <set>

#include "base/angle.hpp"
#include "base/json_node.hpp"
#include "base/names.hpp"
#include "base/text.hpp"
#include "datasets/native/robot_json.hpp"

namespace odobench::csv_import {

void allow_only(const JsonNode& node, const std::vector<std::string>& known) {
  for (const std::string& key : node.keys())
    if (std::find(known.begin(), known.end(), key) == known.end())
      node.fail(fmt::format("unknown key \"{}\"{}", shown(key), did_you_mean(key, known)),
                fmt::format("{}", fmt::join(known, ", ")));
}

void check_map_schema(const JsonNode& root, const std::vector<std::string>& known) {
  const JsonNode schema = root.at("schema");
  if (schema.text() != kMapSchema)
    schema.fail('"' + shown(schema.text()) + '"', fmt::format("\"{}\"", kMapSchema));
  const JsonNode version = root.at("schema_version");
  if (version.integer() != kMapSchemaVersion)
    version.fail(fmt::format("version {}", version.integer()), fmt::format("{}", kMapSchemaVersion));
  allow_only(root, known);
}

namespace {

using Kind = SignalFormat::Kind;

constexpr int kRobotSchema = 2;

std::string not_empty(const JsonNode& node) {
  const std::string text = node.text();
  if (text.empty()) node.fail("an empty text", "a name");
  return text;
}

MappedColumn read_column(const JsonNode& node) {
  const JsonNode column = node.at("column");
  return {not_empty(column), column.path(), 1};
}

MappedColumn read_time(const JsonNode& node, int& digits) {
  allow_only(node, {"column", "unit"});
  const MappedColumn column = read_column(node);
  const std::string unit = node.at("unit").text();
  const std::optional<int> known = time_digits(unit);
  if (!known) node.at("unit").fail('"' + shown(unit) + '"', "\"s\", \"ms\", \"us\" or \"ns\"");
  digits = *known;
  return column;
}

MappedColumn read_reference(const JsonNode& node, bool angle) {
  allow_only(node, {"column", "unit"});
  MappedColumn column = read_column(node);
  const std::string unit = node.at("unit").text();
  const std::optional<double> scale = angle ? angle_scale(unit) : length_scale(unit);
  if (!scale)
    node.at("unit").fail('"' + shown(unit) + '"', angle ? "\"rad\" or \"deg\"" : "\"m\", \"cm\" or \"mm\"");
  column.scale = *scale;
  return column;
}

// Where the map states no kind.
Kind usual_kind(const std::string& unit, bool steering) {
  if (unit == "rpm" || unit.ends_with("/s")) return Kind::Speed;
  if (unit == "m" || unit == "cm" || unit == "mm") return Kind::Travel;
  return steering ? Kind::Angle : Kind::Position;
}

MappedSignal read_signal(const JsonNode& node, const NeededSignal& needed) {
  allow_only(node, {"column", "kind", "unit", "per_turn", "bits", "sign", "radius"});
  MappedSignal signal;
  signal.at = read_column(node);
  signal.format = read_signal_kind(node, usual_kind(node.at("unit").text(), needed.steering));
  signal.format.name = needed.name;
  const SignalKind becomes = signal.format.signal_kind();
  if (needed.steering != (becomes == SignalKind::Angle))
    node.fail(fmt::format("a signal that becomes {} {}", becomes == SignalKind::Speed ? "a" : "an",
                          name_of(becomes)),
              needed.steering ? "an angle: it steers" : "a speed, position, increment or travel: it drives");
  return signal;
}

void read_signals(const JsonNode& node, CsvMap& map) {
  const std::vector<NeededSignal> needed = needed_signals(map.robot);
  std::vector<std::string> names;
  for (const NeededSignal& signal : needed) names.push_back(signal.name);
  for (const std::string& key : node.keys())
    if (std::find(names.begin(), names.end(), key) == names.end())
      node.fail(fmt::format("a signal \"{}\" that the robot has not{}", shown(key), did_you_mean(key, names)),
                fmt::format("{}", fmt::join(names, ", ")));
  const MappedSignal* first = nullptr;
  map.signals.reserve(needed.size());
  for (const NeededSignal& signal : needed) {
    if (!node.has(signal.name))
      node.fail(fmt::format("no signal \"{}\"", shown(signal.name)),
                fmt::format("all of the robot: {}", fmt::join(names, ", ")));
    map.signals.push_back(read_signal(node.at(signal.name), signal));
    if (signal.steering) continue;
    const MappedSignal& last = map.signals.back();
    if (first == nullptr) first = &last;
    if (first->format.signal_kind() != last.format.signal_kind())
      node.at(signal.name)
          .fail(fmt::format("{}s beside the {}s of {}", name_of(last.format.signal_kind()),
                            name_of(first->format.signal_kind()), first->format.name),
                "one of the two for all wheels");
  }
}

// Separator and names of columns of files that have no header line.
void read_format(const JsonNode& node, CsvMap& map) {
  allow_only(node, {"columns", "separator"});
  std::set<std::string> seen;
  for (const JsonNode& name : node.at("columns").elements()) {
    map.columns.push_back(name.text());  // "" is one that nobody needs
    if (!map.columns.back().empty() && !seen.insert(map.columns.back()).second)
      name.fail('"' + shown(map.columns.back()) + '"', "a name that no other column has");
  }
  if (map.columns.empty()) node.at("columns").fail("none", "the names of the columns, in their order");
  if (!node.has("separator")) return;
  const std::string separator = node.at("separator").text();
  if (separator != "," && separator != ";" && separator != "\t" && separator != " ")
    node.at("separator").fail('"' + shown(separator) + '"', R"(",", ";", "\t" or " ")");
  map.separator = separator.front();
}

NamedDrive read_drive(const JsonNode& node) {
  NamedDrive drive;
  if (!node.is_object()) {
    drive.trajectory = not_empty(node);
    return drive;
  }
  allow_only(node, {"trajectory", "repetition"});
  drive.trajectory = not_empty(node.at("trajectory"));
  if (!node.has("repetition")) return drive;
  drive.repetition = node.at("repetition").small_integer();
  if (*drive.repetition < 1) node.at("repetition").fail(fmt::format("{}", *drive.repetition), "1 or more");
  return drive;
}

}  // namespace

std::optional<int> time_digits(std::string_view unit) {
  constexpr std::array<std::pair<std::string_view, int>, 4> units = {
      {{"s", 9}, {"ms", 6}, {"us", 3}, {"ns", 0}}};
  for (const auto& [name, digits] : units)
    if (name == unit) return digits;
  return std::nullopt;
}

std::optional<double> length_scale(std::string_view unit) {
  if (unit == "m") return 1;
  if (unit == "cm") return 0.01;
  if (unit == "mm") return 0.001;
  return std::nullopt;
}

std::optional<double> angle_scale(std::string_view unit) {
  if (unit == "rad") return 1;
  if (unit == "deg") return kDegree;
  return std::nullopt;
}

std::vector<NeededSignal> needed_signals(const Robot& robot) {
  std::vector<NeededSignal> needed;
  const auto add = [&needed](const std::string& name, bool steering) {
    if (std::none_of(needed.begin(), needed.end(), [&](const NeededSignal& s) { return s.name == name; }))
      needed.push_back({name, steering});
  };
  for (const Wheel& wheel : robot.table.wheels)
    for (const DriveSignal& drive : wheel.drive) add(drive.name, false);
  for (const Wheel& wheel : robot.table.wheels)
    if (!wheel.steering.empty()) add(wheel.steering, true);
  return needed;
}

CsvMap parse_csv_map(std::string_view text, const std::string& file) {
  const JsonNode root = JsonNode::parse(text, file);
  check_map_schema(root, {"schema", "schema_version", "name", "description", "source", "licence", "robot",
                          "time", "reference", "signals", "csv", "trajectories"});
  CsvMap map;
  map.file = file;
  map.name = not_empty(root.at("name"));
  map.description = root.text_or_empty("description");
  map.source = root.text_or_empty("source");
  map.licence = root.text_or_empty("licence");
  map.robot = read_robot(root.at("robot"), kRobotSchema);
  map.time = read_time(root.at("time"), map.time_digits);
  const JsonNode reference = root.at("reference");
  allow_only(reference, {"x", "y", "theta"});
  map.x = read_reference(reference.at("x"), false);
  map.y = read_reference(reference.at("y"), false);
  map.theta = read_reference(reference.at("theta"), true);
  read_signals(root.at("signals"), map);
  if (root.has("csv")) read_format(root.at("csv"), map);
  if (root.has("trajectories"))
    for (const std::string& key : root.at("trajectories").keys())
      map.drives[key] = read_drive(root.at("trajectories").at(key));
  return map;
}

}  // namespace odobench::csv_import
