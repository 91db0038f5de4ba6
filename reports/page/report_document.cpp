#include "reports/page/report_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "reports/kinds/calibration/summary_tables.hpp"
#include "reports/kinds/calibration/track_figures.hpp"
#include "reports/kinds/kinds.hpp"
#include "reports/page/method_colours.hpp"

namespace odobench {
namespace {

std::vector<std::string> labels_of(const std::vector<RunRecord>& records) {
  std::vector<std::string> labels;
  for (const RunRecord& r : records)
    if (std::find(labels.begin(), labels.end(), r.label) == labels.end()) labels.push_back(r.label);
  return labels;
}

// "40 runs of lm, ip, ga, pso on vitko2024"
std::string description(const std::vector<RunRecord>& records) {
  std::vector<std::string> labels, sets;
  std::size_t runs = 0;
  const auto add = [](const std::string& name, std::vector<std::string>& list) {
    if (!name.empty() && std::find(list.begin(), list.end(), name) == list.end()) list.push_back(name);
  };
  for (const RunRecord& r : records) {
    if (r.kind == "run") ++runs;
    if (r.label != "nominal") add(r.label, labels);
    const RecordKind& kind = kind_of(r.problem);
    add(kind.set_name != nullptr ? kind.set_name(r) : r.dataset, sets);
    if (r.dataset.empty()) add(r.problem, sets);
  }
  const auto list = [](const std::vector<std::string>& names, std::size_t most) {
    std::string text;
    for (std::size_t i = 0; i < std::min(names.size(), most); ++i) text += (i > 0 ? ", " : "") + names[i];
    return names.size() > most ? text + fmt::format(" and {} more", names.size() - most) : text;
  };
  return fmt::format("{}{} on {}", runs > 0 ? fmt::format("{} run{} of ", runs, runs == 1 ? "" : "s") : "",
                     list(labels, 8), list(sets, 4));
}

std::string made(const std::vector<RunRecord>& records) {
  std::string first;
  for (const RunRecord& r : records)
    if (!r.time_utc.empty()) first = first.empty() ? r.time_utc : std::min(first, r.time_utc);
  const RunContext& c = records.front().context;
  return fmt::format("{}, odobench {} (revision {}), {}", first, c.version, c.git_revision, c.cpu);
}

// The tracks that the tables of `kind` belong to; all tracks of a page share the rows that it may have.
std::vector<PlacedTracks> placed_tracks(const RecordKind& kind, const std::vector<TrackSet>& tracks) {
  const auto wanted = [&](const TrackSet& set) { return shows(kind, set.problem); };
  const bool several = std::count_if(tracks.begin(), tracks.end(), wanted) > 1;
  std::vector<PlacedTracks> placed;
  for (std::size_t i = 0; i < tracks.size(); ++i)
    if (wanted(tracks[i]))
      placed.push_back({&tracks[i], tracks.size() > 1 ? fmt::format("{}.", i + 1) : "",
                        several ? fmt::format(" ({}, {})", i + 1, tracks[i].dataset) : "",
                        kTrackRows / tracks.size()});
  return placed;
}

}  // namespace

Document make_report(const ReportInput& input) {
  Document document;
  document.title = input.title.empty() ? description(input.records) : input.title;
  document.subtitle = made(input.records);
  Section summary{"summary", "Summary", description(input.records) + ".", {}};
  std::vector<Table> overall = summary_tables(input.records);
  std::reverse(overall.begin(), overall.end());
  append(std::move(overall), summary);
  for (const RecordKind& kind : record_kinds()) {
    if (kind.page == nullptr) continue;
    const KindInput part{records_shown(kind, input.records), placed_tracks(kind, input.tracks), input.notes};
    if (!part.records.empty()) kind.page(part, summary, document);
  }
  for (const std::string& sentence : input.absent) summary.blocks.emplace_back(Paragraph{sentence});
  if (!summary.blocks.empty()) document.sections.insert(document.sections.begin(), std::move(summary));
  Section provenance{"provenance", "Provenance", "What the numbers depend on.", {}};
  append(provenance_tables(input.records), provenance);
  finish(std::move(provenance), document);
  share_method_colours(document, labels_of(input.records));
  return document;
}

}  // namespace odobench
