#include "datasets/native/sensor_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace odobench {
namespace {

using Json = nlohmann::ordered_json;

std::string table_of(const SensorRows& rows) {
  std::string text = fmt::format("time_us,{}\n", fmt::join(rows.columns, ","));
  for (std::size_t k = 0; k < rows.time_us.size(); ++k) {
    text += fmt::format("{}", rows.time_us[k]);
    for (const std::vector<double>& column : rows.values) text += fmt::format(",{}", column[k]);
    text += '\n';
  }
  return text;
}

const SensorRows* rows_of(const SetSensors& sensors, const std::string& id, const std::string& name) {
  const auto found = sensors.find(id);
  if (found == sensors.end()) return nullptr;
  for (const SensorRows& rows : found->second)
    if (rows.name == name) return &rows;
  return nullptr;
}

Json entry_of(const SetSensors& sensors, const std::vector<std::string>& ids, const std::string& name,
              const std::string& folder) {
  const bool gyro = name == "gyro";
  Json entry{{"name", name},
             {"type", gyro ? "yaw_rate" : "relative_pose"},
             {"file", fmt::format("{}/{}_{{recording}}.csv", folder, name)},
             {"columns", {{"time", "time_us"}}}};
  double deviation = 0, delay = 0;
  Json standing = Json::object();
  for (const std::string& id : ids) {
    const SensorRows& rows = *rows_of(sensors, id, name);
    delay = std::max(delay, rows.delay_s);
    if (!rows.standing) continue;
    deviation = std::max(deviation, rows.standing->deviation);
    standing[id] = rows.standing->mean;
  }
  if (!gyro) {
    if (delay > 0) entry["delay_s"] = delay;
    entry["filter"] = {{"sigma_position", 0.02}, {"sigma_heading", 0.02}};
    return entry;
  }
  if (!standing.empty()) entry["standing"] = standing;
  entry["filter"] = {{"sigma_yaw_rate", deviation > 1e-6 ? deviation : 0.01}};
  return entry;
}

}  // namespace

std::vector<std::string> add_sensor_files(const SetSensors& sensors, const std::vector<std::string>& ids,
                                          const std::filesystem::path& set_json, FileTransaction& files) {
  const std::string stem = set_json.stem().string(), folder = stem + "_recordings";
  std::vector<std::string> remarks;
  Json listed = Json::array();
  for (const std::string name : {"gyro", "camera"}) {
    std::vector<std::string> missing;
    for (const std::string& id : ids) {
      const SensorRows* rows = rows_of(sensors, id, name);
      if (rows == nullptr)
        missing.push_back(id);
      else
        files.add(set_json.parent_path() / folder / fmt::format("{}_{}.csv", name, id), table_of(*rows));
    }
    if (missing.empty())
      listed.push_back(entry_of(sensors, ids, name, folder));
    else if (missing.size() < ids.size())
      remarks.push_back(fmt::format("{}: no rows in {}: not in the sensors file", name, missing.front()));
  }
  if (listed.empty()) return remarks;
  const Json root{
      {"description", "measured, of the logs that the set was made of; deviations are first guesses"},
      {"wheels", {{"sigma_velocity", 0.01}, {"sigma_yaw_rate", 0.02}}},
      {"sensors", listed}};
  const std::filesystem::path file = sensors_file_of(set_json);
  files.add(file, root.dump(2) + "\n");
  remarks.push_back(fmt::format("{}: the sensors for bench fuse --sensors", file.string()));
  return remarks;
}

std::filesystem::path sensors_file_of(const std::filesystem::path& set_json) {
  return set_json.parent_path() / (set_json.stem().string() + "_sensors.json");
}

}  // namespace odobench
