#include "reports/kinds/fusion/fusion_kinds.hpp"

#include <optional>
#include <utility>

#include "reports/kinds/calibration/table_parts.hpp"
#include "reports/kinds/calibration/track_figures.hpp"
#include "reports/kinds/fusion/fusion_figures.hpp"
#include "reports/kinds/fusion/fusion_record.hpp"
#include "reports/kinds/fusion/tuning_tables.hpp"

namespace odobench {
namespace {

std::vector<FusionRow> fusion_rows(const std::vector<RunRecord>& records) {
  std::vector<FusionRow> rows;
  for (const RunRecord& r : records) rows.push_back(fusion_row(r));
  return rows;
}

void add_fusion_page(const KindInput& input, Section& summary, Document& document) {
  for (const Comparison& c : compare(input.records))
    if (std::optional<Table> totals = totals_table(c)) summary.blocks.emplace_back(std::move(*totals));
  const std::vector<std::string>& notes = input.records.front().notes;
  if (!notes.empty()) summary.blocks.emplace_back(Paragraph{notes.front() + "."});
  Section section{"fusion", "Sensor fusion", "Odometry fused with a camera and a gyro.", {}};
  for (const std::string& note : notes) section.blocks.emplace_back(Paragraph{note});
  const std::vector<FusionRow> rows = fusion_rows(input.records);
  append(fusion_tables(nullptr, input.records, rows), section);
  add_consistency_figures(rows, "", section, document);
  for (const PlacedTracks& tracks : input.tracks) add_track_figures(tracks, section, document);
  finish(std::move(section), document);
}

}  // namespace

RecordKind fusion_kind() {
  return {"fusion",
          "odometry, alone or fused by one filter: errors, consistency, innovations",
          [](std::string_view problem) { return problem == kFusionProblem; },
          nullptr,
          [](const KindInput& input) {
            return fusion_tables(nullptr, input.records, fusion_rows(input.records));
          },
          add_fusion_page,
          nullptr};
}

RecordKind tuning_kind() {
  return {"tuning",
          "noise parameters of a filter, given or fitted: cost, and how they do on other drives",
          [](std::string_view problem) { return problem.substr(0, problem.find(':')) == kTuningProblem; },
          "calibration",
          nullptr,
          nullptr,
          nullptr};
}

}  // namespace odobench
