// Figures of the fusion (`bench fuse`).
#pragma once

#include <string>
#include <vector>

#include "reports/figures/document.hpp"
#include "reports/kinds/fusion/fusion_tables.hpp"

namespace odobench {

// NEES over the instants against its band, and NIS of every sensor against its.
void add_consistency_figures(const std::vector<FusionRow>& rows, const std::string& prefix, Section& section,
                             Document& document);

}  // namespace odobench
