// Figures of the relative-entropy filter (`bench filter`, `bench windows`) and of the fusion (`bench fuse`).
#pragma once

#include <string>
#include <vector>

#include "reports/document.hpp"
#include "reports/fusion_tables.hpp"
#include "reports/record.hpp"

namespace odobench {

// Of one record of `bench filter`: signals before, after and truth as bands over the run, their first rows as lines, and the
// histogram of the gap to the optimum where it was measured.
void add_filter_figures(const RunRecord& record, const std::string& prefix, Section& section,
                        Document& document);

// Of all records of `bench windows`: histogram of the gap to the optimum, per method.
void add_window_figure(const std::vector<RunRecord>& records, const std::string& prefix, Section& section,
                       Document& document);

// NEES over the instants against its band, and NIS of every sensor against its.
void add_consistency_figures(const std::vector<FusionRow>& rows, const std::string& prefix, Section& section,
                             Document& document);

}  // namespace odobench
