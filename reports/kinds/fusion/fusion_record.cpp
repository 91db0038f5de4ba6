#include "reports/kinds/fusion/fusion_record.hpp"

#include <algorithm>
#include <array>

namespace odobench {
namespace {

struct Field {
  const char* name;
  double FusionSensorRow::*member;
};
constexpr std::array<Field, 6> kSensorFields{{{"used", &FusionSensorRow::used},
                                              {"rejected", &FusionSensorRow::rejected},
                                              {"late", &FusionSensorRow::late},
                                              {"nis", &FusionSensorRow::mean_nis},
                                              {"lower", &FusionSensorRow::lower},
                                              {"upper", &FusionSensorRow::upper}}};

FusionSensorRow& sensor_called(const std::string& name, std::vector<FusionSensorRow>& sensors) {
  const auto found = std::find_if(sensors.begin(), sensors.end(),
                                  [&](const FusionSensorRow& sensor) { return sensor.name == name; });
  if (found != sensors.end()) return *found;
  sensors.emplace_back().name = name;
  return sensors.back();
}

}  // namespace

void put_fusion_row(const FusionRow& row, RunRecord& record) {
  record.problem = kFusionProblem;
  record.kind = "evaluation";
  record.label = row.label;
  record.statistics["rmse_position"] = row.rmse_position;
  record.statistics["rmse_heading"] = row.rmse_heading;
  if (!row.filtered) return;
  record.message = row.verdict;
  record.statistics["nees_mean"] = row.mean_nees;
  record.statistics["nees_inside"] = row.inside;
  record.statistics["nees_lower"] = row.lower;
  record.statistics["nees_upper"] = row.upper;
  record.series["nees"] = row.nees;
  for (const FusionSensorRow& sensor : row.sensors) {
    const std::string prefix = "sensor." + sensor.name + ".";
    for (const Field& field : kSensorFields) record.statistics[prefix + field.name] = sensor.*field.member;
    record.statistics[prefix + "dof"] = sensor.dof;
  }
}

FusionRow fusion_row(const RunRecord& record) {
  FusionRow row;
  row.label = record.label;
  row.verdict = record.message;
  const auto figure = [&](const char* name, double& value) {
    const auto found = record.statistics.find(name);
    if (found != record.statistics.end()) value = found->second;
    return found != record.statistics.end();
  };
  figure("rmse_position", row.rmse_position);
  figure("rmse_heading", row.rmse_heading);
  row.filtered = figure("nees_mean", row.mean_nees);
  figure("nees_inside", row.inside);
  figure("nees_lower", row.lower);
  figure("nees_upper", row.upper);
  if (const auto nees = record.series.find("nees"); nees != record.series.end()) row.nees = nees->second;
  const std::string prefix = "sensor.";
  for (const auto& [key, value] : record.statistics) {
    const std::size_t dot = key.rfind('.');
    if (key.rfind(prefix, 0) != 0 || dot <= prefix.size()) continue;
    FusionSensorRow& sensor = sensor_called(key.substr(prefix.size(), dot - prefix.size()), row.sensors);
    const std::string name = key.substr(dot + 1);
    if (name == "dof") sensor.dof = static_cast<int>(value);
    for (const Field& field : kSensorFields)
      if (name == field.name) sensor.*field.member = value;
  }
  return row;
}

}  // namespace odobench
