#include "reports/kinds/fusion/fusion_record.hpp"

#include <array>
#include <string>

namespace odobench {
namespace {

constexpr double kMostDof = 100;  // a pose has three; whatever a file says must fit an int

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

std::string measure_name(const std::string& sensor, const char* figure) {
  return "sensor." + sensor + "." + figure;
}

}  // namespace

void put_fusion_row(const FusionRow& row, RunRecord& record) {
  record.problem = kFusionProblem;
  record.kind = "evaluation";
  record.label = row.label;
  record.measures.put({"rmse_position", row.rmse_position, "m"});
  record.measures.put({"rmse_heading", row.rmse_heading, "rad"});
  if (!row.filtered) return;
  record.message = row.verdict;
  record.measures.put({"nees_mean", row.mean_nees, ""});
  record.measures.put({"nees_inside", row.inside, ""});
  record.measures.put({"nees_lower", row.lower, ""});
  record.measures.put({"nees_upper", row.upper, ""});
  record.series["nees"] = row.nees;
  for (const FusionSensorRow& sensor : row.sensors) {
    for (const Field& field : kSensorFields)
      record.measures.put(
          {measure_name(sensor.name, field.name), sensor.*field.member, "", Better::None, sensor.name});
    const auto dof = static_cast<double>(sensor.dof);
    record.measures.put({measure_name(sensor.name, "dof"), dof, "", Better::None, sensor.name});
  }
}

FusionRow fusion_row(const RunRecord& record) {
  FusionRow row;
  row.label = record.label;
  row.verdict = record.message;
  const Measures& measures = record.measures;
  const auto figure = [&](const std::string& name, double& value) {
    value = measures.value(name).value_or(value);
  };
  figure("rmse_position", row.rmse_position);
  figure("rmse_heading", row.rmse_heading);
  row.filtered = measures.find("nees_mean") != nullptr;
  figure("nees_mean", row.mean_nees);
  figure("nees_inside", row.inside);
  figure("nees_lower", row.lower);
  figure("nees_upper", row.upper);
  if (const auto nees = record.series.find("nees"); nees != record.series.end()) row.nees = nees->second;
  for (const std::string& name : measures.subjects()) {
    FusionSensorRow& sensor = row.sensors.emplace_back();
    sensor.name = name;
    for (const Field& field : kSensorFields) figure(measure_name(name, field.name), sensor.*field.member);
    const double dof = measures.value(measure_name(name, "dof")).value_or(0);
    if (dof >= 0 && dof <= kMostDof) sensor.dof = static_cast<int>(dof);
  }
  return row;
}

}  // namespace odobench
