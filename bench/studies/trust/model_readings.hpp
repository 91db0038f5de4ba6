// What fits of several models say about each of them: which is physical, which only fits, which to use.
#pragma once

#include <vector>

#include "bench/studies/trust/model_fits.hpp"
#include "reports/records/record.hpp"

namespace odobench {

// Adds to the records (nominal, then one per model in the order of `fits`) a note with the reading of each
// and its evidence, and marks the recommended model:
//   only fits    an extra parameter is on a bound, or changes sign between folds; a free time offset is more
//                than 20 ms from the measured lag; mean free headings of a trajectory to the left and of
//                one to the right are opposite, above three standard errors and 5 mrad: a turning error
//   measured     a held lag: known without a model
//   explains     a contact offset that J falls by; physical only if no factor on the drives of one kind does
//                nearly as much (it keeps at least 90 % of the gain)
// Recommended: among those that beat nominal for another repetition and for a new kind of drive (as far as
// there are two of each), do not only fit and are models of a robot, those within 1 % of nominal's total of
// the best at another repetition; of them the one with the fewest free parameters, then the lowest BIC.
void read_models(const std::vector<ModelFits>& fits, double lag, std::vector<RunRecord>& records);

}  // namespace odobench
