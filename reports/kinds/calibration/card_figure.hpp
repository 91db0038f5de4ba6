// A calibration on one picture: the drive that gained most, the one that gained least, and the parameters.
#pragma once

#include <string>

#include "reports/figures/document.hpp"
#include "reports/kinds/kind.hpp"
#include "reports/statistics/row_groups.hpp"

namespace odobench {

// "x 62 -> 10 mm, y 44 -> 11 mm, heading 6.1 -> 2.4 deg; 6 of 18 mean errors got worse": means over the
// trajectories of the mean largest errors e_sr (as in the thesis' totals), nominal and best run. "" without
// both.
std::string change_words(const Comparison& comparison);

// Appends the figure "card": paths of motion capture, nominal and best parameters on the drive whose RMS
// distance fell most and on the one where it fell least or rose (from the first of `tracks` that belongs to
// the comparison), and the parameters of the best run as deviations from nominal in % with their box and
// 95 % intervals. Nothing without a run, or without a nominal evaluation.
void add_card_figure(const Comparison& comparison, const std::vector<PlacedTracks>& tracks,
                     const std::string& prefix, Section& section, Document& document);

}  // namespace odobench
