// Faults that users' recordings have, put into made-up sets of known truth, in any size.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "datasets/dataset.hpp"

namespace odobench::testing {

// make_robot_demo() of the class whose wheels report speeds, as those of most robots: 20 Hz, noise of 0.2 mm
// and 0.5 mrad, true parameters in known_parameters.
Dataset clean_set(const std::string& kinematics, std::uint64_t seed);

// Reads a parameter's column or reference of every recording.
struct Fault {
  std::string name;           // "rpm"
  std::string kind;           // the finding that names it
  std::vector<double> sizes;  // from what is hardly seen to what is; one: there is no smaller
  std::string unit;           // of the sizes
  std::function<void(Dataset&, double)> inject;  // of the thesis' robot
  bool mended = false;                           // a mended set calibrates like the clean one
  std::size_t wheel = 0;                         // that the finding names
  std::string recording = {};                    // that the finding names
};

// One per kind at least.
const std::vector<Fault>& faults();

}  // namespace odobench::testing
