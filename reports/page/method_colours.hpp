// One colour per method over all figures of a page.
#pragma once

#include <string>
#include <vector>

#include "reports/figures/document.hpp"

namespace odobench {

// The palette (reports/web/theme.js) has nine places: seven of methods, the eighth is grey, the ninth the
// colour of text.
inline constexpr std::size_t kMethodColours = 7;

// Scales "color" and "shape" of figures whose domain consists of `labels`, "nominal" and "motion capture"
// get one domain for all figures: the labels in this order, with "nominal" on the grey place and "motion
// capture" on that of text; what a figure does not have stays out of its legend. After seven methods colours
// are used again. Other scales stay.
void share_method_colours(Document& document, const std::vector<std::string>& labels);

}  // namespace odobench
