// Statistics of optimisers over records of several solvers on several problems, as tables and figures.
//
//   ert          per problem and solver: expected running time to gaps of 0.1, 1e-3, 1e-5, 1e-7
//                (trials.hpp: what a gap is), successes at the last with Wilson's interval
//   profiles     per solver: success rate over all runs with Wilson's interval, values of the
//                runtime distribution, of the data and of the performance profile
//   ranks        per solver: mean rank over the problems; in the notes Friedman's test and
//                Nemenyi's critical difference
//   rank_pairs   per pair of solvers: Nemenyi's p, Wilcoxon's signed rank test of their ERT problem
//                by problem with Holm's correction over all pairs, Hodges and Lehmann's shift as a
//                factor
//
// Rank: by ERT to a gap of 1e-7; solvers that never reach it behind all that do, by the median of their
// last gaps.
#pragma once

#include <vector>

#include "reports/figures/document.hpp"
#include "reports/records/record.hpp"
#include "reports/render/table.hpp"

namespace odobench {

inline constexpr std::size_t kFewestSolvers = 2, kFewestProblems = 3;

// Nothing unless two solvers at least ran on three problems at least, both counted as trial_table() does.
std::vector<Table> optimiser_tables(const std::vector<RunRecord>& records);

// The same tables with their figures as sections `ert`, `profiles` and `ranks` of a page.
void add_optimiser_sections(const std::vector<RunRecord>& records, Document& document);

}  // namespace odobench
