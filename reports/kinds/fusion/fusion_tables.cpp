#include "reports/kinds/fusion/fusion_tables.hpp"

#include <fmt/format.h>

#include <utility>

#include "reports/kinds/calibration/table_parts.hpp"
#include "reports/statistics/row_groups.hpp"

namespace odobench {
namespace {

Cell band_cell(double lower, double upper) {
  return text_cell(fmt::format("{:.2f} .. {:.2f}", lower, upper));
}

Table consistency_table(const std::vector<FusionRow>& rows) {
  Table table;
  table.id = "consistency";
  table.title = "Root mean square errors, and whether the covariance says so";
  table.columns = {text_column("label", "parameters"),
                   best_if(Better::Lower, number_column("rmse_position", "RMSE position", "m")),
                   best_if(Better::Lower, number_column("rmse_heading", "RMSE heading", "rad")),
                   number_column("nees", "NEES"),
                   number_column("nees_band", "95 % band"),
                   number_column("nees_inside", "inside", "%"),
                   text_column("verdict")};
  for (const FusionRow& row : rows) {
    std::vector<Cell> cells{text_cell(row.label), fixed_cell(row.rmse_position, 6),
                            fixed_cell(row.rmse_heading, 6)};
    if (row.filtered) {
      cells.push_back(fixed_cell(row.mean_nees, 2));
      cells.push_back(band_cell(row.lower, row.upper));
      cells.push_back(fixed_cell(100 * row.inside, 0));
      cells.push_back(text_cell(row.verdict));
    } else {
      cells.insert(cells.end(), 4, Cell{});
    }
    table.rows.push_back(std::move(cells));
  }
  table.notes.push_back(
      "NEES: e' P^-1 e of the pose, mean over the recordings at each of 100 instants, then over these; 3 is "
      "expected. "
      "Inside: part of the instants at which the mean over the recordings lies in its 95 % band.");
  table.notes.push_back(
      "Innovations (NIS) can look perfect while the estimate drifts with its sensor: they compare the filter "
      "with its "
      "own measurements, NEES compares it with the truth.");
  return table;
}

Table innovation_table(const std::vector<FusionRow>& rows) {
  Table table;
  table.id = "innovations";
  table.title = "Innovations by sensor";
  table.columns = {text_column("label", "parameters"),
                   text_column("sensor"),
                   number_column("used"),
                   number_column("rejected"),
                   number_column("late"),
                   number_column("nis", "NIS"),
                   number_column("expected"),
                   number_column("nis_band", "95 % band")};
  for (const FusionRow& row : rows)
    for (const FusionSensorRow& s : row.sensors)
      table.rows.push_back({text_cell(row.label), text_cell(s.name), count_cell(s.used),
                            count_cell(s.rejected), count_cell(s.late), fixed_cell(s.mean_nis, 3),
                            count_cell(s.dof), band_cell(s.lower, s.upper)});
  table.notes.push_back(
      "Rejected: innovations beyond the gate. Late: arrived too long after their stamp to be used.");
  return table;
}

}  // namespace

std::vector<Table> fusion_tables(const Table* sensors, const std::vector<RunRecord>& records,
                                 const std::vector<FusionRow>& rows) {
  std::vector<Table> tables;
  if (sensors != nullptr) tables.push_back(*sensors);
  for (std::size_t i = 0; i < records.size(); ++i) {
    if (!rows.at(i).filtered) continue;
    const std::vector<RunRecord> one{records[i]};
    for (const Comparison& comparison : compare(one))
      if (std::optional<Table> table = error_overview(comparison)) {
        table->id = "errors." + records[i].label;
        table->title = "Errors of the fusion with " + records[i].label;
        tables.push_back(std::move(*table));
      }
  }
  for (const Comparison& comparison : compare(records)) {
    for (Table& table : error_tables(comparison)) tables.push_back(std::move(table));
    if (std::optional<Table> totals = totals_table(comparison)) tables.push_back(std::move(*totals));
  }
  tables.push_back(consistency_table(rows));
  Table innovations = innovation_table(rows);
  if (!innovations.rows.empty()) tables.push_back(std::move(innovations));
  return tables;
}

}  // namespace odobench
