// What is to be simulated: a robot with four steered and driven wheels whose true parameters are known, its
// drives, its controller, its sensors and their faults. The defaults are the character of the 30 recordings
// that J. Vitko published with his thesis (University of Zagreb, 2024), measured in them. On disk a scenario
// is JSON (docs/simulation.md).
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "datasets/dataset.hpp"
#include "datasets/robot_4wis4wid.hpp"
#include "problems/simulation/kinematics.hpp"

namespace odobench::simulate {

// Uniform, unless stated otherwise.
struct Range {
  double low = 0, high = 0;
};

// One or more phases of constant body velocity, one after the other.
struct Phase {
  Twist twist;
  double duration_s = 0;
};
struct Drive {
  std::string name, description;
  std::vector<Phase> phases;
  // Wheels made to fight a little: added to their commanded steering, rad, and a factor of their commanded
  // speed. By commands that agree with each other no drive shows more than nine combinations of the twelve
  // parameters: the true body velocity is then a 3 x 3 matrix times the commanded one.
  PerWheel steering_offset{};
  PerWheel speed_factor{1, 1, 1, 1};

  // The commands for a body velocity; standing wheels keep `held` (without offsets).
  WheelState command(const Parameters& believed, const Twist& twist, const PerWheel& held = {}) const;
  double duration() const;
  // Where the reference is at time t, clamped to [0, duration], starting at the origin.
  Pose reference(double t) const;
  Twist reference_twist(double t) const;  // zero at and after the end
};

// The six reference drives of the thesis in the order of its tables (trajectories_4wis4wid()).
std::vector<Drive> reference_drives();
// These and others that excite more: diagonals, crab circles, tight circles, figures of eight, turns about a
// wheel, and lines with one wheel fighting. The candidates of drive planning.
std::vector<Drive> known_drives();

enum class Kinematics { Published, LeastSquares };

struct TrueRobot {
  Parameters parameters{};  // nominal by default
  Kinematics kinematics = Kinematics::Published;
  ContactOffset contact_offset{};              // m
  double steering_limit = 1.5707963267948966;  // rad, to either side
};

struct Control {
  bool closed_loop = true;  // else: the constant commands of the drive, whatever happens
  Parameters believed{};    // of the robot's own odometry and inverse kinematics; nominal by default
  double gain_position = 4.5, gain_heading = 3;  // 1/s, of the error in its own odometry
  double delay_s = 0.096;                        // of that error
  Range lead_s{0.27, 0.37};         // by how much the reference is ahead when the robot begins to move
  double wheel_lag_s = 0.036;       // twice: two first-order lags
  double steering_rate = 4.6;       // rad/s
  double steering_bias = 0.0014;    // rad, standard deviation over recordings of a servo's deviation
  double steering_wander = 0.0003;  // rad, median over recordings of its standard deviation within one
  double wander_time_s = 8;         // correlation time of the wander
};

struct Odometry {
  double rate_hz = 62.5;
  double speed_quantum = 0.229 * 2 * 3.14159265358979323846 / 60;  // rad/s; 0: none
  double steering_quantum = 2 * 3.14159265358979323846 / 4096;     // rad; 0: none
  double speed_noise = 0.0133;                                     // rad/s, while the wheel turns
  double stamp_jitter_s = 0.00038;                                 // of the robot's own clock
  // Delay of receipt: with probability on_time |N(0, on_time_s)|, else exponential; now and then a stall.
  double on_time = 0.5, on_time_s = 0.001, delay_s = 0.004;
  double stall_probability = 0.0005;
  Range stall_s{0.03, 0.19};
};

struct Capture {
  double rate_hz = 64;
  double poll_s = 0.01;    // messages are taken from the queue on this grid; 0: at once
  double delay_s = 0.006;  // mean of the exponential delay
  double stall_probability = 0.01;
  Range stall_s{0.015, 0.07};
  Range loss{0.01, 0.042};       // share of lost messages of a recording
  double position_noise = 5e-5;  // m
  double heading_noise = 5e-5;   // rad
};

// Standing before and after the drive, s: low + (high - low) u^2 with u uniform.
struct Idle {
  Range before_s{0.65, 4.5}, after_s{2.8, 8.3};
};

// Where the robot stands when the motion capture says (0, 0, 0).
struct StartPose {
  double position = 0.001;  // m, uniform to either side in x and y
  double heading = 0.003;   // rad, standard deviation; never beyond 0.007
};

// What the wheels do on the ground. Gains are by trajectory, 1 where absent.
struct Gains {
  double linear = 1, angular = 1;
};
struct Slip {
  double fixed = 0;     // standard deviation over recordings of the share of its speed that a wheel loses
  double random = 0;    // standard deviation within a recording of that share, correlated over half a second
  double yaw_bias = 0;  // rad/s while moving
  std::map<std::string, Gains> gains;
};

struct RecordingScenario {
  std::string name, description;
  bool exact =
      false;    // no noise, jitter, loss, quanta, lags, slip: constant commands, one clock, 0.96 s idle
  Robot robot;  // nominal parameters and box
  TrueRobot truth;
  std::vector<Drive> drives;
  int repetitions = 5;
  Control control;
  Odometry odometry;
  Capture capture;
  Idle idle;
  StartPose start;
  Slip slip;
};

// The nominal robot on the six reference drives.
RecordingScenario default_scenario();

// Ticks of the odometry and captured samples of one repetition of the drive, at most.
double most_samples(const RecordingScenario& scenario, const Drive& drive);
// Of all drives with their repetitions.
double most_samples(const RecordingScenario& scenario);

// The nominal values of a robot with the twelve parameters.
Parameters nominal_parameters(const Robot& robot);

// Throws DataError "WHERE: what was found, expected ...": names, negative or non-finite values, values beyond
// any wheeled robot (docs/simulation.md lists the limits), rates <= 0, durations <= 0, probabilities outside
// [0, 1], ranges the wrong way round, a drive that needs a steering angle beyond the limit, a believed or
// true wheel at the origin or with radius <= 0, gains of a trajectory that is not driven, contradictory
// options (exact with slip, gains, or closed loop), a feedback too fast for its delay.
void validate(const RecordingScenario& scenario, const std::string& where);

}  // namespace odobench::simulate
