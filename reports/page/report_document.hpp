// Stored records and tracks -> the report that people look at.
#pragma once

#include <string>
#include <vector>

#include "reports/figures/document.hpp"
#include "reports/records/record.hpp"
#include "reports/records/tracks.hpp"

namespace odobench {

struct ReportInput {
  std::vector<RunRecord> records;
  std::vector<TrackSet> tracks;
  std::string title;                // "" for one made of what was run
  std::vector<std::string> notes;   // below the parameter tables, as of comparison_tables()
  std::vector<std::string> absent;  // what could have been shown, one sentence each: goes into the summary
};

// The summary, the sections of every kind of record in the order of reports/kinds/kinds.hpp (those without
// content are left out), the provenance. A pure function of its input.
Document make_report(const ReportInput& input);

// What the results depend on: set-ups (distinct), and seeds, options and stop of every run.
std::vector<Table> provenance_tables(const std::vector<RunRecord>& records);

}  // namespace odobench
