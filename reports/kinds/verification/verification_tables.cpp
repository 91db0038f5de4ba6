#include "reports/kinds/verification/verification_tables.hpp"

#include <fmt/format.h>

#include <map>
#include <string>

namespace odobench {
namespace {

constexpr const char* kPosition = "arrival_position.";
constexpr const char* kHeading = "arrival_heading.";
constexpr int kDigits = 6;

Cell cell_of(const RunRecord& record, const std::string& name) {
  const auto found = record.statistics.find(name);
  return found == record.statistics.end() ? Cell{} : fixed_cell(found->second, kDigits);
}

}  // namespace

std::optional<Table> arrival_table(const std::vector<RunRecord>& records) {
  std::vector<std::string> drives;
  if (!records.empty())
    for (const auto& [name, value] : records.front().statistics)
      if (name.rfind(kPosition, 0) == 0) drives.push_back(name.substr(std::string(kPosition).size()));
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
      table.rows.back().push_back(cell_of(record, kPosition + drive));
      table.rows.back().push_back(cell_of(record, kHeading + drive));
    }
  }
  return table;
}

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
