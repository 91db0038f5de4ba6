// The 35 test problems of J. J. More, B. S. Garbow, K. E. Hillstrom, "Testing unconstrained optimization software", ACM
// Transactions on Mathematical Software 7(1), 1981, pp. 17-41. J = r'r with exact Jacobian.
//
// mgh:NAME begins at the paper's start, mgh:NAME/10 and mgh:NAME/100 at 10 and 100 times it; where the start is zero
// (watson), at 10 (1, ..., 1) and 100 (1, ..., 1) as in the authors' own programs.
// Box: |x_i| <= 10 max(|start_i|, |x*_i|, 1), start with its factor, x* every known minimiser.
//
// Where the paper leaves the number of residuals m free: jennrich-sampson 10, gulf 99, box-3d 10, brown-dennis 20, biggs-exp6
// 13, linear-* m = 2n, chebyquad m = n. In gulf the misprinted product of the paper is the difference |y_i - x2|.
//
// Lowest known costs stand in mgh_optima.cpp; other stationary points of the paper and later ones, where a method may
// rightly end:
//   freudenstein-roth  48.98425 at (11.41, -0.8968)
//   jennrich-sampson   259.58 as one of x1, x2 falls; a plateau for both far below zero
//   bard               17.4286 as x2, x3 go to minus infinity at x1 = 0.8406
//   kowalik-osborne    1.02734e-3 as x1, x3, x4 go to infinity at x2 = -14.07
//   meyer              a narrow curved valley of steep condition; from 10 times the start it leads away
//   gulf               0.0380 at (99.895, 60.615, 9.161) and (201.66, 60.616, 10.225)
//   box-3d             0 also at (10, 1, -1) and on the line x1 = x2, x3 = 0
//   biggs-exp6         5.65565e-3 and 0.306367; 0 for every order of the three exponentials
//   osborne-2          1.78981
//   trigonometric      2.79506e-5 (n = 10)
//   brown-almost-linear  1 at (0, ..., 0, n + 1); 0 also at (a, ..., a, a^(1-n)) for every root a of
//                      n a^n - (n + 1) a^(n-1) + 1
//   chebyquad          every order of its abscissae; 6.50395e-3 for n = 10, which the paper states as the minimum (symmetric
//                      abscissae; others reach 4.77271e-3)
//   powell-badly-scaled  0 also with x1 and x2 exchanged
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
