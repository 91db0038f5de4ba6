#include "reports/kinds/verification/verification_tables.hpp"

#include <fmt/format.h>

#include <map>
#include <optional>
#include <string>

namespace odobench {
namespace {

constexpr int kArrivalDigits = 6;

Cell cell_of(const RunRecord& record, const std::string& name) {
  const std::optional<double> value = record.measures.value(name);
  return value ? fixed_cell(*value, kArrivalDigits) : Cell{};
}

// Of one data set.
std::optional<Table> arrival_table(const std::vector<RunRecord>& records) {
  std::vector<std::string> drives;
  if (!records.empty()) drives = records.front().measures.subjects();
  if (drives.empty()) return std::nullopt;
  Table table{"verify.arrival",
              "How far from the reference's end the robot really stopped",
              {text_column("parameters")},
              {},
              {}};
  for (const std::string& drive : drives) {
    table.columns.push_back(best_if(Better::Lower, number_column("position_" + drive, drive, "m", drive)));
    table.columns.push_back(
        best_if(Better::Lower, number_column("heading_" + drive, "heading", "rad", drive)));
  }
  for (const RunRecord& record : records) {
    table.rows.push_back({text_cell(record.label)});
    for (const std::string& drive : drives) {
      table.rows.back().push_back(cell_of(record, kArrivalPosition + drive));
      table.rows.back().push_back(cell_of(record, kArrivalHeading + drive));
    }
  }
  return table;
}

}  // namespace

std::vector<Table> arrival_tables(const std::vector<RunRecord>& records) {
  std::map<std::string, std::vector<RunRecord>> sets;
  for (const RunRecord& record : records)
    if (record.problem == kVerificationProblem) sets[record.dataset].push_back(record);
  std::vector<Table> tables;
  for (const auto& [name, members] : sets) {
    std::optional<Table> table = arrival_table(members);
    if (!table) continue;
    if (sets.size() > 1) {
      table->id = fmt::format("{}.{}", name, table->id);
      table->title += ", " + name;
    }
    tables.push_back(std::move(*table));
  }
  return tables;
}

}  // namespace odobench
