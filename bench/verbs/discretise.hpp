// `bench discretise`: F, Psi, Gamma and Q of a linear system for a period, exact or as a series cut after an
// order.
//
// console, md, csv: a table per matrix; json: the matrices as arrays of rows with all digits; latex: bmatrix
// environments (amsmath). Throws std::invalid_argument on a bad option, DataError on a bad file.
#pragma once

#include "bench/verbs/verb.hpp"

namespace odobench {

VerbAction add_discretise(CLI::App& app);

}  // namespace odobench
