// `bench discretise`: F, Psi, Gamma and Q of a linear system for a period, exact or as a series cut after an order.
#pragma once

#include <optional>
#include <string>

#include "bench/console/exit_code.hpp"

namespace odobench {

struct DiscretiseOptions {
  std::string system;  // JSON file, see problems/kalman/system_file.hpp
  double period = 0;
  std::optional<int> order;  // of the series; none: exact only
  std::string format = "console";
};

// console, md, csv: a table per matrix; json: the matrices as arrays of rows with all digits; latex: bmatrix
// environments (amsmath). Throws std::invalid_argument on a bad option, DataError on a bad file.
ExitCode discretise_command(const DiscretiseOptions& options);

}  // namespace odobench
