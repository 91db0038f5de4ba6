// The functions of more_wild.hpp that mgh:* does not have.
#pragma once

#include <string_view>
#include <vector>

#include "problems/classic/mgh_functions.hpp"

namespace odobench {

// bdqrtic, cube, mancino, heart8.
const std::vector<MghFunction>& more_wild_functions();

// Their lowest known costs and minimisers: by Newton's method from the paper's start in 50 digits.
MghOptimum more_wild_optimum(std::string_view name, int n);

}  // namespace odobench
