// Figures of the relative-entropy filter (`bench filter`, `bench windows`).
#pragma once

#include <string>
#include <vector>

#include "reports/figures/document.hpp"
#include "reports/records/record.hpp"

namespace odobench {

// Of one record of `bench filter`: signals before, after and truth as bands over the run, their first rows as
// lines, and the histogram of the gap to the optimum where it was measured.
void add_filter_figures(const RunRecord& record, const std::string& prefix, Section& section,
                        Document& document);

// Of all records of `bench windows`: histogram of the gap to the optimum, per method.
void add_window_figure(const std::vector<RunRecord>& records, const std::string& prefix, Section& section,
                       Document& document);

}  // namespace odobench
