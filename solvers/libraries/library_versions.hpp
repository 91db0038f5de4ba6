// What the numbers of a run depend on besides our own code.
#pragma once

#include <string>

namespace odobench {

// "Ceres 2.1.0, Ipopt 3.11.9, NLopt 2.7.1, Eigen 3.4.0": compiled against, NLopt as linked.
std::string library_versions();

}  // namespace odobench
