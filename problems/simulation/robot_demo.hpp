// A small made-up data set of any class of robots, with the parameters that it was made with.
#pragma once

#include <cstdint>
#include <string>

#include "datasets/dataset.hpp"

namespace odobench {

// The robot of the class with its usual dimensions; true parameters differ by up to 4 % (lengths), 2 degrees
// (angles) and 3 % (ratios) from the nominal ones. Drives that the class can do: squares of 1.5 m and circles
// of 0.6 m radius in both senses, an eight, a straight line, and sideways where possible; three repetitions
// each, 20 Hz. Wheels follow their commands within 3 % and 2 degrees, each in its own rhythm, and the robot
// moves as the rules of its class say of them: twists are constant between two stamps, so that `arc`, or
// Euler's rule of the thesis' robot, is exact for the true increments. Wheels report increments of 4,096
// counts a turn, steering angles multiples of a turn / 4,096; the reference has noise of 0.2 mm and 0.5 mrad.
// The same seed gives the same bits. Throws std::invalid_argument on an unknown class.
Dataset make_robot_demo(const std::string& kinematics, std::uint64_t seed);

}  // namespace odobench
