// `bench tune`: the noise parameters of a filter, fitted by solvers on the first drive of each trajectory and judged on
// the others.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bench/console/exit_code.hpp"
#include "problems/instruction_set.hpp"

namespace odobench {

struct TuneOptions {
  std::string data;  // empty: the demo set
  std::string parameters = "nominal";
  std::string sensors;               // file
  std::vector<std::string> solvers;  // comma lists; empty: nlopt:bobyqa
  std::string filter = "ekf";
  std::string objective = "likelihood";
  std::int64_t max_evaluations = 200;
  std::optional<std::uint64_t> seed;
  std::optional<InstructionSet> kernel;
  std::string out;  // sensors file to write; empty: none
  bool overwrite = false;
  std::string format = "console";
};

ExitCode tune_command(const TuneOptions& options);

}  // namespace odobench
