// What an evaluation of a robot holds; of the files of WheeledRobot only.
#pragma once

#include <vector>

#include "problems/robots/wheel_rows.hpp"
#include "problems/robots/wheeled_robot.hpp"

namespace odobench::robots {

// Allocated once per call, filled sample by sample.
struct WheeledRobot::Workspace {
  std::vector<WheelNumbers> wheels;
  std::vector<WheelReading> readings;
  std::vector<Contact> contacts;
  Cholesky3 normal = Cholesky3(Eigen::Matrix3d::Identity());
};

}  // namespace odobench::robots
