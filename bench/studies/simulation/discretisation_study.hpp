// A continuous linear system made discrete: the study behind `bench discretise`.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "reports/render/table.hpp"

namespace odobench {

struct DiscretisationStudy {
  std::filesystem::path system;  // JSON file, see problems/kalman/system_file.hpp
  double period = 0;             // time step, s
  std::optional<int> order;      // of the series of the exponential; none: exact only
};

// F, Psi, Gamma and Q of problems/kalman/linear_system.hpp, those that the system has, and with a series its
// errors.
struct DiscreteSystem {
  std::vector<Table> tables;
  std::string json;   // every digit, and the tables
  std::string latex;  // equations
};

// Throws DataError on a bad file, and where the result overflows.
DiscreteSystem discretise_system(const DiscretisationStudy& study);

}  // namespace odobench
