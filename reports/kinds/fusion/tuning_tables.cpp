#include "reports/kinds/fusion/tuning_tables.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace odobench {
namespace {

// "likelihood" of "tuning:likelihood"
std::string objective_of(const RunRecord& record) {
  return record.problem.substr(record.problem.find(':') + 1);
}

double measured(const RunRecord& record, const char* name) {
  return record.measures.value(name).value_or(std::numeric_limits<double>::quiet_NaN());
}

Table sigma_table(const std::vector<RunRecord>& records, const TuningCircumstances& tuning) {
  Table table{"sigmas", "Standard deviations that the filter believes", {text_column("parameter")}, {}, {}};
  for (const RunRecord& r : records) table.columns.push_back(number_column(r.label, r.label));
  for (std::size_t i = 0; i < records.front().parameters.size(); ++i) {
    const std::string& name = records.front().parameters[i].name;
    table.rows.push_back({text_cell(name.substr(name.find(' ') + 1))});
    for (const RunRecord& r : records)
      table.rows.back().push_back(significant_cell(std::pow(10.0, r.parameters.at(i).value), 4));
  }
  table.notes.push_back("Position in m, heading in rad, velocity in m/s, yaw rate in rad/s.");
  table.notes.insert(table.notes.end(), tuning.remarks.begin(), tuning.remarks.end());
  return table;
}

Table tuning_table(const std::vector<RunRecord>& records, const TuningCircumstances& tuning) {
  const std::string objective = objective_of(records.front());
  Table table{
      "tuning",
      fmt::format("Tuning by {} on {} recordings, judged on {}{}", objective, tuning.training,
                  tuning.held_out == 0 ? tuning.training : tuning.held_out,
                  tuning.held_out == 0 ? " (the same ones: there are no others)" : " others"),
      {text_column("setting"), best_if(Better::Lower, number_column("cost")), number_column("evaluations"),
       best_if(Better::Lower, number_column("rmse_position", "RMSE position", "m")),
       best_if(Better::Lower, number_column("rmse_heading", "RMSE heading", "rad")),
       number_column("nees", "NEES"), text_column("verdict"), text_column("stop")},
      {},
      {}};
  for (const RunRecord& r : records)
    table.rows.push_back(
        {text_cell(r.label), r.cost ? significant_cell(*r.cost, 8) : Cell{},
         count_cell(static_cast<double>(r.evaluations)), fixed_cell(measured(r, "rmse_position"), 6),
         fixed_cell(measured(r, "rmse_heading"), 6), fixed_cell(measured(r, "nees_mean"), 2),
         text_cell(r.message), text_cell(r.termination == "evaluated" ? "" : r.termination)});
  if (objective == "likelihood")
    table.notes.push_back(
        "The likelihood sees the innovations only: sensors that drift make it prefer sigmas that follow "
        "them. Compare NEES.");
  return table;
}

}  // namespace

std::vector<Table> tuning_tables(const std::vector<RunRecord>& records, const TuningCircumstances& tuning) {
  if (records.empty()) return {};
  return {sigma_table(records, tuning), tuning_table(records, tuning)};
}

}  // namespace odobench
