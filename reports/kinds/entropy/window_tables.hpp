// Tables of windows of the relative-entropy filter solved by several methods (`bench windows`). Such a record
// has problem kWindowProblem, data set "FILE/ID", the group of the window, t as parameters, and unless it was
// skipped the measures
//   samples                                  N
//   hamiltonian, r1, sx1, sy1, ax12, ay12    at t
//   hamiltonian_rounded                      at t rounded to -1, 0, 1: the same for methods on the lattice
//   hamiltonian_zero, hamiltonian_exact, hamiltonian_relaxed   without increments, best on the lattice, best
//   in the box
#pragma once

#include <string>
#include <vector>

#include "reports/records/record.hpp"
#include "reports/render/table.hpp"

namespace odobench {

inline constexpr const char* kWindowProblem = "entropy";

//   windows   a row per window and method: H, closed forms, t, iterations
//   methods   a row per method over all windows: gaps to the optimum and to the relaxation, share of windows
//             at the optimum, iterations, evaluations, time
// `full_digits` writes a t that is not on the lattice with every digit (for machines), else with three.
std::vector<Table> window_tables(const std::vector<RunRecord>& records, bool full_digits);

}  // namespace odobench
