#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <set>

#include "base/files.hpp"
#include "base/json_node.hpp"
#include "base/sha256.hpp"
#include "base/text.hpp"
#include "datasets/dataset.hpp"
#include "datasets/native/columns.hpp"
#include "datasets/native/dataset_format.hpp"
#include "datasets/native/recording_file.hpp"
#include "datasets/native/robot_json.hpp"
#include "datasets/native/signal_format.hpp"
#include "datasets/native/validate.hpp"
#include "datasets/robot_4wis4wid.hpp"

namespace odobench {
namespace fs = std::filesystem;
namespace {

// Which schema the set has.
int check_schema(const JsonNode& root) {
  const JsonNode schema = root.at("schema");
  if (schema.text() != kDatasetSchema)
    schema.fail('"' + schema.text() + '"', fmt::format("\"{}\"", kDatasetSchema));
  const JsonNode version = root.at("schema_version");
  if (version.integer() < 1 || version.integer() > kDatasetSchemaVersion)
    version.fail(fmt::format("version {}", version.integer()),
                 fmt::format("version 1 or {}", kDatasetSchemaVersion));
  if (version.integer() == 1)
    root.allow_only({"schema", "schema_version", "name", "description", "robot", "trajectories", "recordings",
                     "reference", "known_parameters", "provenance", "notes"});
  else
    root.allow_only({"schema", "schema_version", "name", "description", "robot", "signals", "trajectories",
                     "recordings", "reference", "known_parameters", "provenance", "notes"});
  return static_cast<int>(version.integer());
}

ReferenceKind read_reference_kind(const JsonNode& node) {
  const std::string name = node.text();
  const auto found = std::find(kReferenceKindNames.begin(), kReferenceKindNames.end(), name);
  if (found == kReferenceKindNames.end())
    node.fail('"' + shown(name) + '"', "\"poses\", \"drifting\" or \"headings\"");
  return static_cast<ReferenceKind>(found - kReferenceKindNames.begin());
}

// What a set says about the columns of its recordings.
struct ColumnsFormat {
  int schema = 1;
  std::vector<SignalFormat> signals;  // of schema 2

  // A recording without samples that has the signals.
  Recording recording() const {
    if (schema == 1) return recording_4wis4wid();
    Recording empty;
    for (const SignalFormat& format : signals)
      empty.signals.push_back({format.name, format.signal_kind(), {}});
    return empty;
  }
};

ColumnsFormat read_columns_format(const JsonNode& root, int schema) {
  ColumnsFormat format{schema, {}};
  if (schema == 1) return format;
  std::set<std::string> names = {"time_us", "x", "y", "theta"};
  for (const JsonNode& signal : root.at("signals").elements()) {
    format.signals.push_back(read_signal_format(signal));
    const std::string& name = format.signals.back().name;
    if (name.empty() || !names.insert(name).second)
      signal.at("name").fail('"' + shown(name) + '"', "a name that no other column has");
  }
  return format;
}

Trajectory read_trajectory(const JsonNode& node) {
  node.allow_only({"name", "description"});
  return {node.at("name").text(), node.text_or_empty("description")};
}

// Values come as {"a1": ..., ...}: no order to get wrong in a file written by hand.
NamedParameters read_known_parameters(const JsonNode& node, const Robot& robot) {
  node.allow_only({"name", "description", "values"});
  NamedParameters known{node.at("name").text(), node.text_or_empty("description"), {}};
  const JsonNode values = node.at("values");
  for (const std::string& key : values.keys())
    if (std::none_of(robot.parameters.begin(), robot.parameters.end(),
                     [&](const auto& p) { return p.name == key; }))
      values.fail(fmt::format("unknown key \"{}\"", key), "the names in /robot/parameters");
  for (const RobotParameter& p : robot.parameters) known.values.push_back(values.at(p.name).number());
  return known;
}

Provenance read_provenance(const JsonNode& node) {
  node.allow_only({"source", "licence", "made_by", "files"});
  Provenance provenance{
      node.text_or_empty("source"), node.text_or_empty("licence"), node.text_or_empty("made_by"), {}};
  if (!node.has("files")) return provenance;
  for (const JsonNode& file : node.at("files").elements()) {
    file.allow_only({"path", "sha256"});
    provenance.files.push_back({file.at("path").text(), file.at("sha256").text()});
  }
  return provenance;
}

// Id, trajectory and repetition only: the set as a whole is checked before any recording is opened.
Recording read_recording_head(const JsonNode& node, const ColumnsFormat& format) {
  node.allow_only({"id", "trajectory", "repetition", "samples", "file", "sha256", "columns"});
  Recording recording = format.recording();
  recording.id = node.at("id").text();
  recording.trajectory = node.at("trajectory").text();
  const std::int64_t repetition = node.at("repetition").integer();
  if (repetition < 1 || repetition > std::numeric_limits<int>::max())
    node.at("repetition").fail(fmt::format("{}", repetition), "1 or more");
  recording.repetition = static_cast<int>(repetition);
  if (node.has("columns") == node.has("file"))
    node.fail(node.has("file") ? "both \"file\" and \"columns\"" : "neither \"file\" nor \"columns\"",
              "one of them");
  return recording;
}

void read_inline_columns(const JsonNode& node, const ColumnsFormat& format, Recording& recording) {
  if (node.has("sha256")) node.fail("\"sha256\" beside inline columns", "it beside \"file\" only");
  const JsonNode columns = node.at("columns");
  recording.time_us = columns.at("time_us").integers();
  std::vector<std::string> names = {"time_us"};
  for_each_value_column(recording, format.schema,
                        [&](const std::string& name, const char*, std::vector<double>& values) {
                          const bool of_reference = names.size() <= 3;
                          values = format.schema > 1 && of_reference ? columns.at(name).stored_numbers()
                                                                     : columns.at(name).numbers();
                          names.push_back(name);
                        });
  for (const std::string& key : columns.keys())
    if (std::find(names.begin(), names.end(), key) == names.end())
      columns.fail(fmt::format("unknown key \"{}\"", shown(key)), fmt::format("{}", fmt::join(names, ", ")));
  if (format.schema > 1) drop_missing_reference(recording);
  if (const auto fault = find_fault(recording, format.schema)) {
    const JsonNode column = columns.at(fault->column);
    throw DataError(fmt::format("{}: {}{}: {}", column.file(), column.path(),
                                fault->sample ? fmt::format("/{}", *fault->sample) : "", fault->what));
  }
  if (node.has("samples") && node.at("samples").integer() != static_cast<std::int64_t>(recording.size()))
    node.at("samples").fail(fmt::format("{}", node.at("samples").integer()),
                            fmt::format("{} as in time_us", recording.size()));
  for (std::size_t i = 0; i < format.signals.size(); ++i) {
    std::vector<double>& values = recording.signals[i].values;
    if (const auto sample = beyond_counter(format.signals[i], values))
      columns.at(format.signals[i].name)
          .elements()[*sample]
          .fail(fmt::format("{}", values[*sample]),
                fmt::format("a count of {} bits", format.signals[i].bits));
    convert(format.signals[i], values);
  }
}

// FOLDER/TEXT, which a set that comes from elsewhere must not use to name a file outside its folder: neither
// by its text nor through a link.
fs::path file_below(const fs::path& folder, const JsonNode& node) {
  const std::string text = node.text();
  const fs::path relative = text;
  const bool climbs = std::find(relative.begin(), relative.end(), "..") != relative.end();
  const bool odd = std::any_of(text.begin(), text.end(), [](unsigned char c) { return c < 0x20; });
  if (relative.empty() || relative.is_absolute() || climbs || odd)
    node.fail('"' + shown(text) + '"', "a path below the folder of the set");
  fs::path file = folder;
  std::error_code e;
  bool linked = false;
  for (const fs::path& part : relative) linked = fs::is_symlink(file /= part, e) || linked;
  if (!linked) return file;
  const fs::path inside = fs::weakly_canonical(folder.empty() ? "." : folder, e);
  const fs::path target = fs::weakly_canonical(file, e);
  if (std::mismatch(inside.begin(), inside.end(), target.begin(), target.end()).first != inside.end())
    node.fail(fmt::format("a link to {}", shown_path(target)), "a file below the folder of the set");
  return file;
}

void read_recording_file(const JsonNode& node, const fs::path& folder, const ColumnsFormat& format,
                         Recording& recording) {
  for (const SignalFormat& signal : format.signals)
    if (!signal.plain())
      node.at("file").fail(fmt::format("a recording file beside the signal '{}' in {}", shown(signal.name),
                                       shown(signal.unit)),
                           "speeds in rad/s, increments and angles in rad, or inline columns");
  const fs::path file = file_below(folder, node.at("file"));
  const std::int64_t samples = node.at("samples").integer();
  if (samples < 2) node.at("samples").fail(fmt::format("{} samples", samples), "at least 2");
  const std::string sum = node.at("sha256").text();
  if (!is_sha256(sum)) node.at("sha256").fail('"' + sum + '"', "64 lower-case hexadecimal digits");
  decode_recording(read_file(file), {file.string(), static_cast<std::size_t>(samples), sum, format.schema},
                   recording);
}

}  // namespace

Dataset load_dataset(const fs::path& set_json) {
  const JsonNode root = JsonNode::read(set_json);
  const int schema = check_schema(root);
  Dataset d;
  d.name = root.at("name").text();
  d.description = root.text_or_empty("description");
  d.robot = read_robot(root.at("robot"), schema);
  const ColumnsFormat format = read_columns_format(root, schema);
  for (const JsonNode& t : root.at("trajectories").elements()) d.trajectories.push_back(read_trajectory(t));
  const std::vector<JsonNode> recordings = root.at("recordings").elements();
  for (const JsonNode& r : recordings) d.recordings.push_back(read_recording_head(r, format));
  if (root.has("reference")) d.reference = read_reference_kind(root.at("reference"));
  if (root.has("known_parameters"))
    for (const JsonNode& k : root.at("known_parameters").elements())
      d.known_parameters.push_back(read_known_parameters(k, d.robot));
  if (root.has("provenance")) d.provenance = read_provenance(root.at("provenance"));
  if (root.has("notes"))
    for (const JsonNode& n : root.at("notes").elements()) d.notes.push_back(n.text());
  validate_dataset(d, set_json.string());

  for (std::size_t i = 0; i < recordings.size(); ++i) {
    if (recordings[i].has("columns"))
      read_inline_columns(recordings[i], format, d.recordings[i]);
    else
      read_recording_file(recordings[i], set_json.parent_path(), format, d.recordings[i]);
  }
  return d;
}

}  // namespace odobench
