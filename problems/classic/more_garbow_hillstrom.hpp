// The 35 test problems of J. J. More, B. S. Garbow, K. E. Hillstrom, "Testing unconstrained optimization
// software", ACM Transactions on Mathematical Software 7(1), 1981, pp. 17-41. J = r'r with exact Jacobian.
//
// mgh:NAME begins at the paper's start, mgh:NAME/10 and mgh:NAME/100 at 10 and 100 times it; where the start
// is zero (watson), at 10 (1, ..., 1) and 100 (1, ..., 1) as in the authors' own programs.
// Box: |x_i| <= 10 max(|start_i|, |x*_i|, 1), start with its factor, x* every known minimiser.
//
// Where the paper leaves the number of residuals m free: jennrich-sampson 10, gulf 99, box-3d 10,
// brown-dennis 20, biggs-exp6
// 13, linear-* m = 2n, chebyquad m = n. In gulf the misprinted product of the paper is the difference |y_i -
// x2|.
//
// Lowest known costs and minimisers stand in mgh_optima.cpp. Other minima where a method may rightly end,
// with their values in docs/problems.md: freudenstein-roth 48.98425; valleys to infinity of bard (17.4286)
// and kowalik-osborne (1.02734e-3); plateaus of jennrich-sampson (259.58, 2020), gaussian and gulf (32.835);
// biggs-exp6 5.65565e-3; trigonometric 2.79506e-5 (n = 10); brown-almost-linear 1; osborne-2 1.78981;
// osborne-1, broyden-tridiagonal and chebyquad (n = 10: 6.50395e-3, which the paper states; 4.77271e-3 is
// known). The start of jennrich-sampson/100 has residuals of 1e174: its cost overflows.
#pragma once

#include <string>
#include <vector>

#include "problems/classic/classic_problems.hpp"

namespace odobench {

// Three for each problem: factors 1, 10, 100.
std::vector<ClassicEntry> mgh_entries();
// `name` of mgh_entries(), a dimension that it takes. Throws std::invalid_argument on another name.
Problem make_mgh_problem(const std::string& name, int dimension);

}  // namespace odobench
