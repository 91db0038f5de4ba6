// What a kind of record gives to reports: `bench report` and its page know kinds by these rows alone
// (reports/kinds/kinds.hpp).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "reports/figures/document.hpp"
#include "reports/records/record.hpp"
#include "reports/records/tracks.hpp"
#include "reports/render/table.hpp"

namespace odobench {

// Tracks with their place on the page.
struct PlacedTracks {
  const TrackSet* set = nullptr;
  std::string prefix;    // of the ids of their figures: "" or "2."
  std::string suffix;    // of the titles: "" or " (2, demo)"
  std::size_t rows = 0;  // of their data sets at most
};

struct KindInput {
  std::vector<RunRecord> records;    // of the kind, and of those shown with it; in the order of the report
  std::vector<PlacedTracks> tracks;  // the same
  std::vector<std::string> notes;    // below parameter tables
  bool full_digits = false;          // for machines
};

struct RecordKind {
  const char* name;
  const char* about;  // what one record says
  // Whether records with this RunRecord::problem are of the kind. Null: those that no other row wants.
  bool (*wants)(std::string_view problem);
  // The kind whose tables show these results, too, as further groups of rows; null: none.
  const char* shown_with;
  // As `bench report` prints them, beside those of `shown_with`; null: none.
  std::vector<Table> (*tables)(const KindInput& input);
  // Appends to the summary, which opens the page, and to the document the sections of the kind; null: none.
  void (*page)(const KindInput& input, Section& summary, Document& document);
  // How the page's title calls the data set of a record; null: by its name.
  std::string (*set_name)(const RunRecord& record);
};

inline void append(std::vector<Table> tables, Section& section) {
  for (Table& table : tables) section.blocks.emplace_back(std::move(table));
}
// Sections with nothing in them are left out.
inline void finish(Section section, Document& document) {
  if (!section.blocks.empty()) document.sections.push_back(std::move(section));
}

}  // namespace odobench
