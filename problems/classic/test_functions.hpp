// The family "classic" of classic_problems.hpp.
#pragma once

#include "problems/classic/classic_problems.hpp"

namespace odobench {

std::vector<ClassicEntry> test_function_entries();
// `name` of test_function_entries(), a dimension that it takes. Throws std::invalid_argument on another name.
Problem make_test_function(const std::string& name, int dimension);

}  // namespace odobench
