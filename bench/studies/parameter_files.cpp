#include "bench/studies/parameter_files.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "base/json_node.hpp"
#include "base/sha256.hpp"
#include "bench/studies/parameter_noise.hpp"
#include "bench/studies/records.hpp"
#include "reports/figures/vega.hpp"

namespace odobench {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kIdDigits = 12;
constexpr std::size_t kLongestName = 120;

void add_intervals(const RunRecord& record, std::vector<FoundParameter>& found) {
  if (!record.trust) return;
  for (FoundParameter& one : found)
    for (const ParameterIntervalRecord& own : record.trust->parameters) {
      if (own.name != one.parameter.name) continue;
      one.decided_by = own.interval.reason;
      if (!std::isfinite(own.interval.half_width)) continue;
      one.half_width = own.interval.half_width;
      one.df = own.interval.df;
    }
}

// Those of a record are of its free parameters and relative (record.hpp).
void add_deviations(const RunRecord& record, std::vector<FoundParameter>& found) {
  const auto series = record.series.find("sd_if_samples_were_independent");
  if (series == record.series.end()) return;
  std::vector<FoundParameter*> free;
  for (FoundParameter& one : found)
    if (one.parameter.lower != one.parameter.upper) free.push_back(&one);
  if (free.size() != series->second.size()) return;
  for (std::size_t i = 0; i < free.size(); ++i) {
    const ParameterValue& p = free[i]->parameter;
    const double scale = p.nominal != 0 ? std::abs(p.nominal) : (p.upper - p.lower) / 2;
    const double deviation = series->second[i] * scale;
    if (std::isfinite(deviation)) free[i]->sd_if_samples_were_independent = deviation;
  }
}

// Values of the table's parameters, by name; as they are by default where there is none.
std::vector<double> values_of(const WheelTable& table, const std::vector<ParameterValue>& found) {
  std::vector<double> values;
  for (const BoundParameter& p : table.parameters) {
    values.push_back(p.parameter.nominal);
    for (const ParameterValue& own : found)
      if (own.name == p.parameter.name) values.back() = own.value;
  }
  return values;
}

nlohmann::ordered_json wheels_json(const std::vector<Wheel>& wheels) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Wheel& wheel : wheels) {
    nlohmann::ordered_json one;
    for (std::size_t k = 0; k < kWheelFieldNames.size(); ++k)
      one[std::string(kWheelFieldNames[k])] = wheel.*kWheelFieldMembers[k];
    one["drive"] = nlohmann::ordered_json::array();
    for (const DriveSignal& drive : wheel.drive) one["drive"].push_back(drive.name);
    one["steering"] = wheel.steering;
    one["slides"] = wheel.slides;
    list.push_back(std::move(one));
  }
  return list;
}

std::vector<Wheel> read_wheels(const JsonNode& node) {
  std::vector<Wheel> wheels;
  for (const JsonNode& one : node.elements()) {
    Wheel wheel;
    for (std::size_t k = 0; k < kWheelFieldNames.size(); ++k)
      wheel.*kWheelFieldMembers[k] = one.at(std::string(kWheelFieldNames[k])).number();
    for (const JsonNode& drive : one.at("drive").elements()) wheel.drive.push_back({drive.text(), 1});
    wheel.steering = one.at("steering").text();
    wheel.slides = one.at("slides").boolean();
    wheels.push_back(std::move(wheel));
  }
  return wheels;
}

void read_robot_of(const JsonNode& node, ParameterFile& file) {
  file.robot = node.at("name").text();
  file.kinematics = node.at("kinematics").text();
  const JsonNode ties = node.at("ties");
  for (const std::string& name : ties.keys()) file.ties.emplace_back(name, ties.at(name).text());
  file.wheels = read_wheels(node.at("wheels"));
  file.nominal_wheels = read_wheels(node.at("nominal_wheels"));
  if (file.wheels.empty() || file.wheels.size() != file.nominal_wheels.size())
    node.fail("none, or not as many as nominal ones", "the same wheels twice");
}

// Of earlier versions only what they called the standard deviation.
void read_interval(const JsonNode& node, FoundParameter& found) {
  for (const char* name : {"standard_deviation", "sd_if_samples_were_independent"})
    if (const auto deviation = node.find(name))
      found.sd_if_samples_were_independent = deviation->optional_number();
  const auto interval = node.find("interval");
  if (!interval || !interval->is_object()) return;
  found.half_width = interval->at("half_width").optional_number();
  found.df = interval->at("df").optional_number();
  found.decided_by = interval->text_or_empty("decided_by");
}

nlohmann::ordered_json interval_json(const FoundParameter& found) {
  using Json = nlohmann::ordered_json;
  const auto number = [](const std::optional<double>& value) { return value ? Json(*value) : Json(); };
  Json interval{{"half_width", number(found.half_width)}, {"df", number(found.df)}};
  if (!found.decided_by.empty()) interval["decided_by"] = found.decided_by;
  return interval;
}

std::vector<FoundParameter> read_found(const JsonNode& root) {
  std::vector<FoundParameter> found;
  const JsonNode values = root.at("values");
  for (const JsonNode& node : root.at("parameters").elements()) {
    FoundParameter one;
    ParameterValue& p = one.parameter;
    p.name = node.at("name").text();
    p.unit = node.at("unit").text();
    p.value = values.at(p.name).number();
    p.nominal = node.at("nominal").number();
    p.lower = node.at("lower").number();
    p.upper = node.at("upper").number();
    p.at_bound = node.text_or_empty("at_bound");
    read_interval(node, one);
    found.push_back(std::move(one));
  }
  if (found.size() != values.keys().size()) values.fail("another number of values", "one per parameter");
  return found;
}

// A label as the name of a file that no other label has, and of a length that file systems take.
std::string file_name(const std::string& label, std::set<std::string>& taken) {
  const std::string base = vega::slug(label).substr(0, kLongestName);
  std::string name = base;
  for (int i = 2; !taken.insert(name).second; ++i) name = base + "_" + std::to_string(i);
  return name;
}

}  // namespace

ParameterFile parameter_file(const LoadedProblem& loaded, const RunRecord& record) {
  ParameterFile file;
  file.label = record.label;
  for (const ParameterValue& value : record.parameters) file.parameters.push_back({value, std::nullopt});
  add_intervals(record, file.parameters);
  add_deviations(record, file.parameters);
  if (loaded.calibration && loaded.dataset) {
    const Robot& robot = loaded.dataset->robot;
    file.robot = robot.name;
    file.kinematics = robot.kinematics;
    file.ties = robot.ties;
    const WheelTable table = with_model(robot, loaded.calibration->options().model).table;
    file.wheels = wheels_with(table, values_of(table, record.parameters));
    file.nominal_wheels = wheels_with(table, values_of(table, {}));
  }
  file.noise = noise_figures(record);
  file.run_id = sha256(to_json_line(record)).substr(0, kIdDigits);
  file.problem = record.problem;
  file.dataset = record.dataset;
  file.dataset_sha256 = record.dataset_sha256;
  file.solver = record.solver;
  file.time_utc = record.time_utc;
  file.cost = record.cost;
  return file;
}

std::string to_json_text(const ParameterFile& file) {
  using Json = nlohmann::ordered_json;
  Json root{{"schema", kParameterSchema}, {"schema_version", kParameterSchemaVersion}, {"name", file.label}};
  root["values"] = Json::object();
  root["parameters"] = Json::array();
  for (const FoundParameter& found : file.parameters) {
    const ParameterValue& p = found.parameter;
    root["values"][p.name] = p.value;
    root["parameters"].push_back({{"name", p.name},
                                  {"unit", p.unit},
                                  {"nominal", p.nominal},
                                  {"lower", p.lower},
                                  {"upper", p.upper},
                                  {"interval", interval_json(found)},
                                  {"at_bound", p.at_bound}});
    if (found.sd_if_samples_were_independent)
      root["parameters"].back()["sd_if_samples_were_independent"] = *found.sd_if_samples_were_independent;
  }
  if (!file.kinematics.empty()) {
    Json ties = Json::object();
    for (const auto& [name, other] : file.ties) ties[name] = other;
    root["robot"] = {{"name", file.robot},
                     {"kinematics", file.kinematics},
                     {"ties", ties},
                     {"wheels", wheels_json(file.wheels)},
                     {"nominal_wheels", wheels_json(file.nominal_wheels)}};
  }
  if (file.noise) root["noise"] = noise_json(*file.noise);
  root["run"] = {{"id", file.run_id},        {"problem", file.problem},
                 {"dataset", file.dataset},  {"dataset_sha256", file.dataset_sha256},
                 {"solver", file.solver},    {"cost", file.cost ? Json(*file.cost) : Json()},
                 {"time_utc", file.time_utc}};
  return root.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

ParameterFile read_parameter_file(const fs::path& path) {
  const JsonNode root = JsonNode::read(path);
  if (root.at("schema").text() != kParameterSchema) root.at("schema").fail(kParameterSchema);
  if (root.at("schema_version").integer() != kParameterSchemaVersion)
    root.at("schema_version").fail(std::to_string(kParameterSchemaVersion));
  ParameterFile file;
  file.label = root.at("name").text();
  file.parameters = read_found(root);
  if (const std::optional<JsonNode> robot = root.find("robot")) read_robot_of(*robot, file);
  if (const std::optional<JsonNode> noise = root.find("noise")) file.noise = noise_from(*noise);
  const JsonNode run = root.at("run");
  file.run_id = run.at("id").text();
  file.problem = run.at("problem").text();
  file.dataset = run.at("dataset").text();
  file.dataset_sha256 = run.at("dataset_sha256").text();
  file.solver = run.at("solver").text();
  file.cost = run.at("cost").optional_number();
  file.time_utc = run.at("time_utc").text();
  return file;
}

std::vector<std::pair<fs::path, std::string>> parameter_files(const std::vector<LoadedProblem>& loaded,
                                                              const std::vector<RunRecord>& records) {
  std::vector<std::pair<fs::path, std::string>> files;
  std::set<std::string> folders;
  const std::vector<const RunRecord*> rows = best_of_rows(records);
  for (const LoadedProblem& one : loaded) {
    fs::path folder = kParameterFolder;
    if (loaded.size() > 1) folder /= file_name(one.name(), folders);
    std::set<std::string> taken;
    for (const RunRecord* row : rows)
      if (row->label != "nominal" && row->problem == one.name() && row->dataset == one.dataset_name() &&
          row->parameters.size() == one.problem.parameters().size())
        files.emplace_back(folder / (file_name(row->label, taken) + ".json"),
                           to_json_text(parameter_file(one, *row)));
  }
  return files;
}

std::vector<fs::path> stored_parameter_files(const fs::path& run_directory) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::recursive_directory_iterator at(run_directory / kParameterFolder, error), end; !error && at != end;
       at.increment(error)) {
    if (at.depth() > 0) at.disable_recursion_pending();
    if (at->path().extension() == ".json" && at->is_regular_file(error)) files.push_back(at->path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace odobench
