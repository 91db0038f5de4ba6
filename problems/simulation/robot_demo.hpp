// A small made-up data set of any class of robots, with the parameters that it was made with.
#pragma once

#include <cstdint>
#include <string>

#include "datasets/dataset.hpp"

namespace odobench {

// The robot of the class with its usual dimensions; true parameters differ by up to 4 % (lengths), 2 degrees
// (angles) and 3 % (ratios) from the nominal ones. Its standard drives (robot_drives.hpp), three repetitions
// each, commanded by the true parameters, with the noise of robot_simulator.hpp. The same seed gives the same
// bits. Throws std::invalid_argument on an unknown class.
Dataset make_robot_demo(const std::string& kinematics, std::uint64_t seed);

}  // namespace odobench
