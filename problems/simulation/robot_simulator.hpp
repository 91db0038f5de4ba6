// Recordings of drives of a robot of any class or of wheels of a user's own, whose true parameters are known.
//
// Twists are constant between two stamps (20 Hz), so that `arc`, or Euler's rule of the thesis' robot, is
// exact for the true increments. Wheels follow their commands within 3 % and 2 degrees, each in its own
// rhythm, and the robot moves as the rules of its class say of them. Wheels report increments of 4,096 counts
// a turn, steering angles multiples of a turn / 4,096; the reference has noise of 0.2 mm and 0.5 mrad.
#pragma once

#include "base/random.hpp"
#include "datasets/recording.hpp"
#include "problems/simulation/robot_drives.hpp"

namespace odobench {

struct RobotNoise {
  double position = 2e-4;                                     // of the reference, m
  double heading = 5e-4;                                      // rad
  double drive_wander = 0.03;                                 // of the speed
  double steering_wander = 2 * 3.14159265358979323846 / 180;  // rad
  double counts = 4096;                                       // of a turn
};

// A recording without names, and how far the true end is from the drive's, m and rad.
struct RobotRun {
  Recording recording;
  double position_miss = 0, heading_miss = 0;
};

class RobotSimulator {
 public:
  // Throws std::invalid_argument on a table that is none (robots::check).
  explicit RobotSimulator(Robot robot, const RobotNoise& noise = {});

  const Robot& robot() const { return robot_; }
  const robots::WheeledRobot& model() const { return model_; }
  RobotAbilities abilities(const Vector& z) const { return abilities_of(robot_, model_, z); }
  // Stamps of the drive.
  static double samples(const RobotDrive& drive, const RobotAbilities& can);

  // Commanded by the parameters `believed`: without feedback, or steered by its own odometry with them.
  // `can`: of the believed parameters. Deterministic in its arguments. Throws std::invalid_argument on a
  // twist that the robot cannot do by these parameters, and on wheels that would turn by more than 1e6 rad
  // between two stamps.
  RobotRun record(const RobotDrive& drive, const RobotAbilities& can, const Vector& truth,
                  const Vector& believed, Random& random, bool feedback = false) const;

 private:
  Robot robot_;
  robots::WheeledRobot model_;
  RobotNoise noise_;
};

// Parameters of the robot's table at their nominal values.
Vector nominal_values(const Robot& robot);

}  // namespace odobench
