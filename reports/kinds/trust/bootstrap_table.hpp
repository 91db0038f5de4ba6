// The spread over resamples as a table.
#pragma once

#include <optional>

#include "reports/render/table.hpp"
#include "reports/statistics/row_groups.hpp"

namespace odobench {

// Of the first record that was resampled: a row for J and each parameter with the fit, the percentiles, the
// standard deviation and the share of the replicates on a bound. Nothing where there is none.
std::optional<Table> bootstrap_table(const Comparison& comparison);

}  // namespace odobench
