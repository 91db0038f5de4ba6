#include "reports/kinds/planning/planning_kind.hpp"

#include <utility>

#include "reports/kinds/planning/planning_tables.hpp"

namespace odobench {
namespace {

std::vector<Table> planning_tables_of(const KindInput& input) {
  std::vector<Table> tables;
  for (const RunRecord& record : input.records)
    for (Table& table : planning_tables(record)) tables.push_back(std::move(table));
  return tables;
}

void add_planning_page(const KindInput& input, Section&, Document& document) {
  Section section{"planning", "Planned drives", "What calibrations on these drives would determine.", {}};
  append(planning_tables_of(input), section);
  finish(std::move(section), document);
}

}  // namespace

RecordKind planning_kind() {
  return {"planning",
          "what a set of drives would determine: deviations of the parameters, directions, proposals",
          [](std::string_view problem) { return problem == kPlanningProblem; },
          nullptr,
          planning_tables_of,
          add_planning_page,
          nullptr};
}

}  // namespace odobench
