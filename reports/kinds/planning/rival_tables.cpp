#include "reports/kinds/planning/rival_tables.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "base/angle.hpp"
#include "reports/records/series.hpp"

namespace odobench {
namespace {

// What stands behind `prefix` in the notes that begin with it, cut at " | ".
std::vector<std::pair<std::string, std::string>> pairs_of(const RunRecord& record,
                                                          const std::string& prefix) {
  std::vector<std::pair<std::string, std::string>> list;
  for (const std::string& note : record.notes) {
    if (note.rfind(prefix, 0) != 0) continue;
    const std::string rest = note.substr(prefix.size());
    const std::size_t bar = rest.find(" | ");
    list.emplace_back(rest.substr(0, bar), bar == std::string::npos ? "" : rest.substr(bar + 3));
  }
  return list;
}

std::string conclusion(const std::vector<std::pair<std::string, std::string>>& drives,
                       const std::vector<double>& repetitions) {
  if (drives.empty()) return "";
  const double n = repetitions.front();
  if (!std::isfinite(n))
    return "No drive here decides between the two: what they differ by is lost in the scatter, or the fits "
           "leave it open.";
  return fmt::format("Next: {} ({}), driven {}, decides between them in 95 of 100 cases.",
                     drives.front().first, drives.front().second,
                     n == 1 ? "once" : fmt::format("{:.0f} times", n));
}

}  // namespace

bool has_rivals(const RunRecord& record) {
  return record.series.count("rival_separation") > 0;
}

std::vector<Table> rival_tables(const RunRecord& record) {
  const auto drives = pairs_of(record, kRivalDriveNote), rivals = pairs_of(record, kRivalsNote);
  const std::size_t n = drives.size();
  const std::vector<double>*difference = series_of(record, "rival_difference", 3 * n),
        *scatter = series_of(record, "rival_scatter", 3 * n),
        *separation = series_of(record, "rival_separation", n),
        *evidence = series_of(record, "rival_evidence", n),
        *repetitions = series_of(record, "rival_repetitions", n),
        *seconds = series_of(record, "rival_seconds", n);
  if (n == 0 || rivals.empty() || difference == nullptr || scatter == nullptr || separation == nullptr ||
      evidence == nullptr || repetitions == nullptr || seconds == nullptr)
    return {};
  Table t{"plan.between",
          fmt::format("Drives that decide between {} and {}", rivals.front().first, rivals.front().second),
          {text_column("drive"), best_if(Better::Lower, number_column("repetitions")),
           number_column("separation"), number_column("evidence", "log Bayes factor"),
           number_column("x", "", "mm"), number_column("y", "", "mm"), number_column("heading", "", "deg"),
           number_column("scatter_x", "scatter x", "mm"), number_column("scatter_y", "scatter y", "mm"),
           number_column("scatter_heading", "scatter heading", "deg"), number_column("seconds", "", "s"),
           text_column("description")},
          {},
          {}};
  for (std::size_t i = 0; i < n; ++i) {
    const double times = (*repetitions)[i];
    std::vector<Cell> row = {text_cell(drives[i].first),
                             std::isfinite(times) ? count_cell(times) : text_cell("never"),
                             significant_cell((*separation)[i], 3), significant_cell((*evidence)[i], 3)};
    for (const std::vector<double>* list : {difference, scatter})
      for (std::size_t k = 0; k < 3; ++k)
        row.push_back(fixed_cell((*list)[3 * i + k] * (k < 2 ? 1000 : 1 / kDegree), k < 2 ? 1 : 2));
    row.push_back(fixed_cell((*seconds)[i], 0));
    row.push_back(text_cell(drives[i].second));
    t.rows.push_back(std::move(row));
  }
  if (const std::string text = conclusion(drives, *repetitions); !text.empty()) t.notes.push_back(text);
  t.notes.push_back(fmt::format("J of the recordings that there are: {:.6g} and {:.6g}.",
                                record.measures.value("rival_cost.first").value_or(0),
                                record.measures.value("rival_cost.second").value_or(0)));
  t.notes.emplace_back(
      "x, y, heading: by how much the two predict different ends; scatter: of one drive's end, by the noise "
      "of the recordings. Separation: the difference in standard deviations once the wrong model has bent as "
      "far as the recordings let it; repetitions: until the choice is right in 95 of 100, never: 100 do not "
      "do.");
  for (const std::string& note : record.notes)
    if (note.rfind(kRivalDriveNote, 0) != 0 && note.rfind(kRivalsNote, 0) != 0) t.notes.push_back(note + ".");
  return {t};
}

}  // namespace odobench
