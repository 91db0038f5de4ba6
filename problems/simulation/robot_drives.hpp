// Drives that a robot of any class can do, as body velocities.
#pragma once

#include <string>
#include <vector>

#include "datasets/robots/robot.hpp"
#include "problems/robots/wheeled_robot.hpp"

namespace odobench {

// Constant velocity for a while (m/s, rad/s, s); speeds ramp up and down at its ends.
struct RobotPhase {
  double vx, vy, omega, seconds;
};
struct RobotDrive {
  std::string name, description;
  std::vector<RobotPhase> phases;
};

inline constexpr double kRobotStep = 0.05;  // between two stamps, s

// What a robot can do with parameters z.
struct RobotAbilities {
  bool on_the_spot = true, sideways = false;
  double least_radius = 0;  // m, of circles of the origin; front wheels of cars turn by at most 0.6 rad
  // Directions of travel and the twist of a turn at 1 rad/s: x axis and z axis for every class. Wheels of
  // a user's own may roll elsewhere, and turn about a point that is not the origin.
  Eigen::Vector3d ahead{1, 0, 0}, turn{0, 0, 1};
};
// Throws std::invalid_argument for wheels that hold each other: no straight line, or no turn.
RobotAbilities abilities_of(const Robot& robot, const robots::WheeledRobot& model, const Vector& z);

// Squares of 1.5 m and circles of 0.6 m (cars: 1.3 times their least radius) in both senses, an eight, a line
// of 3 m, and 2 m sideways where possible.
std::vector<RobotDrive> standard_drives(const RobotAbilities& can);
// These and more: a line backwards, wide circles in both senses, two turns on the spot in both senses,
// diagonals and circles with a sideways part where possible. What plans choose from.
std::vector<RobotDrive> known_drives(const RobotAbilities& can);

// Circles of 0.1, 0.2, 0.3, 0.5 and 1 m radius in both senses, those of them that the robot can do: between
// the turn on the spot and the wide circles, where models of contacts and of slip part.
std::vector<RobotDrive> small_circles(const RobotAbilities& can);

// Twists of the intervals of kRobotStep, 3 x N, with half a second of standing before and after.
Matrix twists_of(const RobotDrive& drive, const RobotAbilities& can);

}  // namespace odobench
