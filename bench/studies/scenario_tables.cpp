#include "bench/studies/scenario_tables.hpp"

#include <fmt/format.h>

#include "base/files.hpp"
#include "bench/catalogue/scenarios.hpp"

namespace odobench {
namespace {

std::vector<Table> detail_tables(const simulate::RecordingScenario& s) {
  Table drives{"drives",
               fmt::format("Drives of {}", s.name),
               {text_column("drive"), text_column("description"), number_column("phases"),
                number_column("duration_s", "duration", "s")},
               {},
               {s.description}};
  for (const simulate::Drive& d : s.drives)
    drives.rows.push_back({text_cell(d.name), text_cell(d.description),
                           count_cell(static_cast<double>(d.phases.size())), fixed_cell(d.duration(), 1)});
  Table robot{
      "robot",
      "True and believed parameters",
      {text_column("parameter"), text_column("unit"), number_column("truth"), number_column("believed")},
      {},
      {}};
  for (std::size_t i = 0; i < s.robot.parameters.size(); ++i)
    robot.rows.push_back({text_cell(s.robot.parameters[i].name), text_cell(s.robot.parameters[i].unit),
                          significant_cell(s.truth.parameters[i], 7),
                          significant_cell(s.control.believed[i], 7)});
  return {drives, robot};
}

std::vector<Table> detail_tables(const DynamicsScenario& s) {
  Table segments{"segments",
                 fmt::format("Segments of {}", s.name),
                 {text_column("until_s", "until [s]"), text_column("voltages_V", "voltages [V]"),
                  text_column("steering_deg", "steering [deg]")},
                 {},
                 {s.description}};
  for (const dynamics::Segment& g : s.setup.segments) {
    std::string voltages, steering;
    for (std::size_t i = 0; i < dynamics::kWheels; ++i) {
      voltages += fmt::format("{}{:g}", i > 0 ? ", " : "", g.voltage[i]);
      steering += fmt::format("{}{:g}", i > 0 ? ", " : "", g.steering[i] * 180 / 3.14159265358979323846);
    }
    segments.rows.push_back(
        {text_cell(fmt::format("{:g}", g.until_s)), text_cell(voltages), text_cell(steering)});
  }
  Table robot{"robot",
              "Robot parameters",
              {text_column("parameter"), text_column("symbol"), number_column("value"), text_column("unit"),
               text_column("origin"), text_column("remark")},
              {},
              {"Origin: given by the thesis, or chosen because it gives nothing."}};
  dynamics::RobotParameters copy = s.setup.robot;
  for (const dynamics::ParameterDescription& d : dynamics::parameter_descriptions())
    robot.rows.push_back({text_cell(d.name), text_cell(d.symbol), significant_cell(d.value(copy), 7),
                          text_cell(d.unit), text_cell(d.given ? "given" : "chosen"), text_cell(d.text)});
  return {segments, robot};
}

}  // namespace

std::vector<Table> scenario_tables(const std::string& source) {
  if (!source.empty())
    return std::visit([](const auto& s) { return detail_tables(s); }, load_scenario(source));
  Table table{
      "scenarios",
      "Scenarios, as in bench simulate --scenario=NAME",
      {text_column("scenario"), text_column("kind"), number_column("drives"), text_column("description")},
      {},
      {"'bench list scenarios NAME' shows one in detail; docs/simulation.md describes the format."}};
  for (const auto& [name, path] : known_scenarios()) {
    const Scenario scenario = load_scenario(path.string());
    if (const auto* r = std::get_if<simulate::RecordingScenario>(&scenario))
      table.rows.push_back({text_cell(name), text_cell("recordings"),
                            count_cell(static_cast<double>(r->drives.size()) * r->repetitions),
                            text_cell(r->description)});
    else
      table.rows.push_back({text_cell(name), text_cell("dynamics"), count_cell(1),
                            text_cell(std::get<DynamicsScenario>(scenario).description)});
  }
  return {table};
}

}  // namespace odobench
