// Tables of validations and bootstraps, pure functions of records.
#pragma once

#include <vector>

#include "reports/render/table.hpp"
#include "reports/statistics/row_groups.hpp"

namespace odobench {

// In this order, nothing without a record that was validated or resampled:
//   validation  a row per label: total error as fitted; of recordings left out by each scheme the total, that
//               of the nominal parameters on the same recordings, the change to it and to the fit to all,
//               in %; what validation_sentences.hpp says of the lowest row are its notes
//   folds       a row per fold: J and total error, fitted, left out and nominal; rows with the same folds
//               stand once
//   bootstrap   a row for J and each parameter of the result that was resampled: fit, percentiles, standard
//               deviation, share of the replicates on a bound
std::vector<Table> validation_tables(const Comparison& comparison);

}  // namespace odobench
