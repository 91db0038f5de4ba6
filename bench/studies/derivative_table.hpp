// `bench run --check-derivatives`: what problems state against differences (solvers/derivative_check.hpp), as
// a table.
#pragma once

#include <vector>

#include "bench/catalogue/problem_factory.hpp"
#include "reports/render/table.hpp"

namespace odobench {

// One row per problem, parameter and kind of derivative: the point, of the start and three random ones, where
// it agrees worst.
struct DerivativeTable {
  Table table;
  bool agrees = true;
};

// Random points: derive_seed(base_seed, {problem, data set, "derivatives", number}). Shows its progress on a
// terminal unless `quiet`; throws Interruption.
DerivativeTable check_derivatives(const std::vector<LoadedProblem>& problems, std::uint64_t base_seed,
                                  bool quiet);

}  // namespace odobench
