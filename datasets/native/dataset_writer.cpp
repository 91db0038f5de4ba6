#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/files.hpp"
#include "base/sha256.hpp"
#include "datasets/dataset.hpp"
#include "datasets/native/columns.hpp"
#include "datasets/native/dataset_format.hpp"
#include "datasets/native/recording_file.hpp"
#include "datasets/native/validate.hpp"

namespace odobench {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;  // keys stay in the order in which people read them

constexpr std::size_t kLongestLine = 240;

// Of values that hold no structured ones.
std::string one_line(const Json& value) {
  if (!value.is_structured()) return value.dump();
  std::string text(1, value.is_object() ? '{' : '[');
  for (auto item = value.begin(); item != value.end(); ++item) {
    if (item != value.begin()) text += ", ";
    if (value.is_object()) text += Json(item.key()).dump() + ": ";
    text += item->dump();
  }
  return text + (value.is_object() ? '}' : ']');
}

// A diff should show one parameter or one recording per line: what fits on a line stays there, columns always
// do.
std::string pretty(const Json& value, std::size_t indent) {
  const bool column = value.is_array() && !value.empty() && value.front().is_number();
  if (!value.is_structured() || column) return one_line(value);
  bool flat = true;
  for (const Json& item : value) flat = flat && !item.is_structured();
  if (flat) {
    const std::string line = one_line(value);
    if (line.size() <= kLongestLine) return line;
  }
  std::string text(1, value.is_object() ? '{' : '[');
  const std::string margin(indent + 2, ' ');
  for (auto item = value.begin(); item != value.end(); ++item) {
    text += item == value.begin() ? "\n" : ",\n";
    text += margin;
    if (value.is_object()) text += Json(item.key()).dump() + ": ";
    text += pretty(*item, indent + 2);
  }
  return text + "\n" + std::string(indent, ' ') + (value.is_object() ? '}' : ']');
}

Json robot_json(const Robot& robot) {
  Json parameters = Json::array();
  for (const RobotParameter& p : robot.parameters)
    parameters.push_back(
        {{"name", p.name}, {"unit", p.unit}, {"nominal", p.nominal}, {"lower", p.lower}, {"upper", p.upper}});
  return {{"name", robot.name}, {"kinematics", robot.kinematics}, {"parameters", parameters}};
}

Json known_parameters_json(const Dataset& d) {
  Json all = Json::array();
  for (const NamedParameters& known : d.known_parameters) {
    Json values = Json::object();
    for (std::size_t i = 0; i < known.values.size(); ++i)
      values[d.robot.parameters[i].name] = known.values[i];
    all.push_back({{"name", known.name}, {"description", known.description}, {"values", values}});
  }
  return all;
}

Json provenance_json(const Provenance& p) {
  Json files = Json::array();
  for (const SourceFile& f : p.files) files.push_back({{"path", f.path}, {"sha256", f.sha256}});
  return {{"source", p.source}, {"licence", p.licence}, {"made_by", p.made_by}, {"files", files}};
}

Json recording_head(const Recording& r) {
  return {{"id", r.id}, {"trajectory", r.trajectory}, {"repetition", r.repetition}, {"samples", r.size()}};
}

Json inline_columns(const Recording& r) {
  Json columns = {{"time_us", r.time_us}};
  for_each_value_column(
      r, 1, [&](const std::string& name, const char*, const std::vector<double>& v) { columns[name] = v; });
  return columns;
}

void check(const Dataset& d, const std::string& file) {
  validate_dataset(d, file);
  for (std::size_t i = 0; i < d.recordings.size(); ++i)
    if (const auto fault = find_fault(d.recordings[i], 1))
      throw DataError(
          fmt::format("{}: /recordings/{} ({}): {}{}: {}", file, i, d.recordings[i].id, fault->column,
                      fault->sample ? fmt::format(", sample {}", *fault->sample) : "", fault->what));
}

}  // namespace

std::vector<fs::path> save_dataset(const Dataset& d, const fs::path& set_json, bool inline_recordings,
                                   Existing existing) {
  FileTransaction files(existing);
  add_dataset(d, set_json, files, inline_recordings);
  std::vector<fs::path> written = files.targets();
  files.commit();
  return written;
}

void add_dataset(const Dataset& d, const fs::path& set_json, FileTransaction& files, bool inline_recordings,
                 const Stop& stop) {
  check(d, set_json.string());
  const std::string folder = set_json.stem().string() + "_recordings";
  if (!inline_recordings) require_own_folder(set_json.parent_path() / folder);
  Json recordings = Json::array();
  for (const Recording& r : d.recordings) {
    stop.check();
    Json entry = recording_head(r);
    if (inline_recordings) {
      entry["columns"] = inline_columns(r);
    } else {
      const std::string name = folder + "/" + r.id + ".rec";
      const std::string bytes = encode_recording(r);
      entry["file"] = name;
      entry["sha256"] = sha256(bytes);
      files.add(set_json.parent_path() / name, bytes);
    }
    recordings.push_back(std::move(entry));
  }
  Json trajectories = Json::array();
  for (const Trajectory& t : d.trajectories)
    trajectories.push_back({{"name", t.name}, {"description", t.description}});
  const Json root = {{"schema", kDatasetSchema},
                     {"schema_version", kDatasetSchemaVersion},
                     {"name", d.name},
                     {"description", d.description},
                     {"robot", robot_json(d.robot)},
                     {"trajectories", std::move(trajectories)},
                     {"known_parameters", known_parameters_json(d)},
                     {"provenance", provenance_json(d.provenance)},
                     {"notes", d.notes},
                     {"recordings", std::move(recordings)}};
  std::string text;
  try {
    text = pretty(root, 0) + "\n";
  } catch (const nlohmann::json::exception& e) {  // a text that is not UTF-8
    throw DataError(fmt::format("{}: cannot be written: {}", set_json.string(), e.what()));
  }
  files.add(set_json, text);  // last: it refers to the others
}

}  // namespace odobench
