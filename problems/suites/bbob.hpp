// The 24 noiseless functions of the Black-Box Optimization Benchmarking workshops: N. Hansen, S. Finck, R.
// Ros, A. Auger, "Real-parameter black-box optimization benchmarking 2009: noiseless functions
// definitions", INRIA RR-6829. bbob:f1 to bbob:f24 in 2 to 40 dimensions, box [-5, 5]^n, start at its
// middle. Every function is shifted by x_opt and f_opt and, but for the separable ones, rotated; instances
// 1, 2, ... are those of the COCO platform (bbob_random.hpp).
//
// known_optimum() is f_opt and known_minimisers() x_opt, where f differs from f_opt by rounding only. f16 has
// further minimisers (its cosines repeat), which are not listed. Solved: f - f_opt <= 1e-8, COCO's last
// target. Gradients of f1, f2, f3, f5, f8-f12, f14, f15, f19; the others have kinks, steps, or none that
// would help.
#pragma once

#include <string>
#include <vector>

#include "problems/classic/classic_problems.hpp"

namespace odobench {

inline constexpr int kBbobInstances = 1000;  // named; the generator knows more
inline constexpr double kBbobPrecision = 1e-8;

std::vector<ClassicEntry> bbob_entries();
// `name` of bbob_entries(), a dimension in 2..40, an instance in 1..kBbobInstances. Throws
// std::invalid_argument on anything else.
Problem make_bbob_problem(const std::string& name, int dimension, int instance);

}  // namespace odobench
