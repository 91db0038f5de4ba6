// `bench run --check-derivatives`: what problems state against differences, as a table
// (solvers/certificate/derivative_check.hpp).
#pragma once

#include <vector>

#include "base/stop.hpp"
#include "bench/catalogue/problem_factory.hpp"
#include "bench/studies/watcher.hpp"
#include "reports/render/table.hpp"

namespace odobench {

// One row per problem, parameter and kind of derivative: the point, of the start and three random ones, where
// it agrees worst.
struct DerivativeTable {
  Table table;
  bool agrees = true;
};

// Random points: derive_seed(base_seed, {problem, data set, "derivatives", number}). The watcher
// is told the points. Throws Interruption.
DerivativeTable check_derivatives(const std::vector<LoadedProblem>& problems, std::uint64_t base_seed,
                                  Watcher& watcher, const Stop& stop);

}  // namespace odobench
