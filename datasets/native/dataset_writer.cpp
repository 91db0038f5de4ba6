#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/files.hpp"
#include "base/sha256.hpp"
#include "datasets/dataset.hpp"
#include "datasets/native/columns.hpp"
#include "datasets/native/dataset_format.hpp"
#include "datasets/native/recording_file.hpp"
#include "datasets/native/robot_json.hpp"
#include "datasets/native/validate.hpp"
#include "datasets/robot_4wis4wid.hpp"

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

Json inline_columns(const Recording& sparse, int schema) {
  const Recording r = with_reference_everywhere(sparse);
  Json columns = {{"time_us", r.time_us}};
  // A stamp without a reference is null, which is how the library writes what is not a number.
  for_each_value_column(r, schema, [&](const std::string& name, const char*, const std::vector<double>& v) {
    columns[name] = v;
  });
  return columns;
}

int schema_of(const Dataset& d) {
  const std::vector<Signal> known = recording_4wis4wid().signals;
  const auto as_before = [&](const Recording& r) {
    return r.reference.sample.empty() &&
           std::equal(r.signals.begin(), r.signals.end(), known.begin(), known.end(),
                      [](const Signal& a, const Signal& b) { return a.name == b.name && a.kind == b.kind; });
  };
  return fits_schema_1(d.robot) && std::all_of(d.recordings.begin(), d.recordings.end(), as_before)
             ? 1
             : kDatasetSchemaVersion;
}

Json signals_json(const Dataset& d) {
  Json signals = Json::array();
  for (const Signal& signal : d.recordings.front().signals)
    signals.push_back(
        {{"name", signal.name}, {"kind", name_of(signal.kind)}, {"unit", unit_of(signal.kind)}});
  return signals;
}

void check_signals(const Dataset& d, const std::string& file) {
  const std::vector<Signal>& first = d.recordings.front().signals;
  for (const Recording& r : d.recordings)
    if (!std::equal(r.signals.begin(), r.signals.end(), first.begin(), first.end(),
                    [](const Signal& a, const Signal& b) { return a.name == b.name && a.kind == b.kind; }))
      throw DataError(fmt::format("{}: recording '{}' has other signals than '{}', expected the same in all",
                                  file, r.id, d.recordings.front().id));
}

void check(const Dataset& d, const std::string& file, int schema) {
  validate_dataset(d, file);
  check_signals(d, file);
  for (std::size_t i = 0; i < d.recordings.size(); ++i)
    if (const auto fault = find_fault(d.recordings[i], schema))
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
  if (d.recordings.empty()) validate_dataset(d, set_json.string());  // which refuses it
  const int schema = schema_of(d);
  check(d, set_json.string(), schema);
  const std::string folder = set_json.stem().string() + "_recordings";
  if (!inline_recordings) require_own_folder(set_json.parent_path() / folder);
  Json recordings = Json::array();
  for (const Recording& r : d.recordings) {
    stop.check();
    Json entry = recording_head(r);
    if (inline_recordings) {
      entry["columns"] = inline_columns(r, schema);
    } else {
      const std::string name = folder + "/" + r.id + ".rec";
      const std::string bytes = encode_recording(r, schema);
      entry["file"] = name;
      entry["sha256"] = sha256(bytes);
      files.add(set_json.parent_path() / name, bytes);
    }
    recordings.push_back(std::move(entry));
  }
  Json trajectories = Json::array();
  for (const Trajectory& t : d.trajectories)
    trajectories.push_back({{"name", t.name}, {"description", t.description}});
  Json root = {{"schema", kDatasetSchema},
               {"schema_version", schema},
               {"name", d.name},
               {"description", d.description},
               {"robot", robot_json(d.robot, schema)}};
  if (schema > 1) root["signals"] = signals_json(d);
  if (d.reference != ReferenceKind::Poses) root["reference"] = std::string(name_of(d.reference));
  root["trajectories"] = std::move(trajectories);
  root["known_parameters"] = known_parameters_json(d);
  root["provenance"] = provenance_json(d.provenance);
  root["notes"] = d.notes;
  root["recordings"] = std::move(recordings);
  std::string text;
  try {
    text = pretty(root, 0) + "\n";
  } catch (const nlohmann::json::exception& e) {  // a text that is not UTF-8
    throw DataError(fmt::format("{}: cannot be written: {}", set_json.string(), e.what()));
  }
  files.add(set_json, text);  // last: it refers to the others
}

}  // namespace odobench
