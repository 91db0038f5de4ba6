// The 53 problems of J. J. More, S. M. Wild, "Benchmarking derivative-free optimization algorithms", SIAM
// Journal on Optimization 20(1), 2009, pp. 172-191, in their smooth variant: 22 functions of CUTEr in given
// dimensions, from the usual start and from ten times it. J = r'r with exact Jacobian.
//
// mw:NAME, mw:NAME/10 (ten times the start), mw:NAME-N and mw:NAME-N/10 where a function appears in several
// dimensions. Eighteen functions are those of mgh:*, with the paper's numbers of residuals (linear-* 45, 35,
// 35) and two starts of its own: watson at 1/2 (1, ..., 1), osborne-1 with x3 = +1. Four are new:
//   bdqrtic  r = (3 - 4 x_i, x_i^2 + 2 x_{i+1}^2 + 3 x_{i+2}^2 + 4 x_{i+3}^2 + 5 x_n^2), i = 1 .. n - 4
//   cube     r = (x_1 - 1, 10 (x_i - x_{i-1}^3)), i = 2 .. n
//   mancino  r_i = 1400 x_i + (i - 50)^3 + sum_j v (sin^5 log v + cos^5 log v), v = sqrt(x_i^2 + i / j)
//   heart8   eight equations of dipoles in the heart (Nelson, Hodgkin 1981)
// Box as in mgh:*: |x_i| <= 10 max(|start_i|, |x*_i|, 1).
#pragma once

#include <string>
#include <vector>

#include "problems/classic/classic_problems.hpp"

namespace odobench {

std::vector<ClassicEntry> more_wild_entries();
// `name` of more_wild_entries(). Throws std::invalid_argument on another name.
Problem make_more_wild_problem(const std::string& name);

}  // namespace odobench
