#include "reports/kinds/kinds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <utility>

#include "reports/kinds/calibration/calibration_kind.hpp"
#include "reports/kinds/entropy/entropy_kinds.hpp"
#include "reports/kinds/fusion/fusion_kinds.hpp"
#include "reports/kinds/planning/planning_kind.hpp"
#include "reports/kinds/trust/models_tables.hpp"
#include "reports/kinds/verification/verification_kind.hpp"

namespace odobench {

const std::vector<RecordKind>& record_kinds() {
  static const std::vector<RecordKind> kinds{calibration_kind(), verification_kind(), tuning_kind(),
                                             filter_kind(),      windows_kind(),      fusion_kind(),
                                             planning_kind(),    models_kind()};
  return kinds;
}

const RecordKind& kind_of(std::string_view problem) {
  const RecordKind* rest = nullptr;
  for (const RecordKind& kind : record_kinds()) {
    if (kind.wants == nullptr)
      rest = &kind;
    else if (kind.wants(problem))
      return kind;
  }
  return *rest;
}

bool shows(const RecordKind& kind, std::string_view problem) {
  const RecordKind& own = kind_of(problem);
  return &own == &kind || (own.shown_with != nullptr && std::strcmp(own.shown_with, kind.name) == 0);
}

std::vector<RunRecord> records_shown(const RecordKind& kind, const std::vector<RunRecord>& records) {
  std::vector<RunRecord> shown;
  for (const RunRecord& record : records)
    if (shows(kind, record.problem)) shown.push_back(record);
  return shown;
}

std::vector<Table> record_tables(const std::vector<RunRecord>& records, const std::vector<std::string>& notes,
                                 bool full_digits) {
  std::vector<Table> tables;
  for (const RecordKind& kind : record_kinds()) {
    if (kind.tables == nullptr) continue;
    const KindInput input{records_shown(kind, records), {}, notes, full_digits};
    if (input.records.empty()) continue;
    for (Table& table : kind.tables(input)) tables.push_back(std::move(table));
  }
  return tables;
}

std::vector<std::string> unknown_records(const std::vector<RunRecord>& records) {
  std::map<std::string, std::size_t> unknown;
  for (const RunRecord& r : records) {
    const bool known = kind_of(r.problem).wants != nullptr || r.kind != "evaluation" || r.cost.has_value() ||
                       !r.errors.empty() || (r.measures.empty() && r.series.empty());
    if (!known) ++unknown[r.problem];
  }
  std::vector<std::string> sentences;
  for (const auto& [problem, count] : unknown)
    sentences.push_back(fmt::format(
        "{} record{} of '{}' {} of no kind that this version knows: only the provenance is shown.", count,
        count == 1 ? "" : "s", problem, count == 1 ? "is" : "are"));
  return sentences;
}

}  // namespace odobench
