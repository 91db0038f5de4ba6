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

// Sections, left out when there is nothing for them: summary, errors, trajectories, convergence, parameters,
// identifiability, filter, windows, fusion, provenance. A pure function of its input.
Document make_report(const ReportInput& input);

// The tables of records of any kind, as `bench report` prints them. `full_digits` as in window_tables().
std::vector<Table> record_tables(const std::vector<RunRecord>& records, const std::vector<std::string>& notes,
                                 bool full_digits);

// What the results depend on: set-ups (distinct), and seeds, options and stop of every run.
std::vector<Table> provenance_tables(const std::vector<RunRecord>& records);

}  // namespace odobench
