// The table of NLopt algorithms behind nlopt:NAME.
#pragma once

#include <nlopt.h>

#include <string>
#include <vector>

namespace odobench {

struct NloptAlgorithm {
  std::string name;  // after "nlopt:"
  nlopt_algorithm id;
  std::string summary;
  bool gradient = false;    // needs derivatives
  bool global = false;      // no restarts; stops only by tolerance or limit
  bool stochastic = false;  // its path depends on the seed
  bool population = false;  // has a population size
  bool step = false;        // takes an initial step
  bool memory = false;      // keeps a limited number of gradient pairs
  bool local = false;       // needs a local method (MLSL)
  bool statics = false;     // C++ code with static variables and without a forced stop: StoGO, AGS
  bool late_stop = false;   // must not be stopped before its initial points are done
  bool scalar_step =
      false;            // NLopt's own initial step is the smallest over the parameters: tiny next to a bound
  bool folded = false;  // knows no bounds: runs on the coordinates of solvers/box/boundary_map.hpp
  bool not_for_one = false;  // refuses a single parameter
  int most_parameters = 0;   // 0: any number
};

const std::vector<NloptAlgorithm>& nlopt_algorithms();

}  // namespace odobench
