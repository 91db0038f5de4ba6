// A recording as the inspection sees it: nominal wheels, motions of the reference and of the wheels through
// one filter. What a check recognises it corrects here, so that one fault does not hide the next.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "datasets/recording.hpp"
#include "datasets/robots/robot.hpp"
#include "problems/inspection/statistics.hpp"
#include "problems/robots/wheeled_robot.hpp"

namespace odobench::inspection {

// A wheel with nominal numbers. It rolls along a / |a|, a = e + tan(roller) n, at r w / |a|.
struct WheelView {
  Wheel nominal;
  std::vector<std::pair<Index, double>> drives;  // columns of Drive::motion, weights
  Index steering = -1;                           // column of Drive::angle
  std::string label;                             // "wheel 2", of its drive signal
  std::string steering_label;                    // "steering 2"
  bool driven() const { return !drives.empty(); }
  bool states() const { return driven() || steering >= 0; }  // says something of a velocity
};

struct RobotView {
  // The least-squares twist, whatever the robot's rule. Throws std::invalid_argument as WheeledRobot does.
  explicit RobotView(const Robot& own);
  robots::WheeledRobot twist;
  std::vector<WheelView> wheels;
  double distance = 0;       // rho: mean distance of the wheels from the origin, m
  bool from_origin = false;  // drives begin at (0, 0), as of the thesis' robot
  bool mean = false;         // its twist is the published mean
  // Free parameters of this field, of any wheel: what they are off by is for the calibration to find.
  bool free(WheelField field) const;
  Index steerings() const {  // columns of Drive::angle
    return static_cast<Index>(twist.signals().size()) - twist.drive_count();
  }
  const Robot* robot;
};

// Sums over the used samples, per wheel: u.m, m.m, u.u. Of a wheel that only steers the first two are the
// part of u.u along its direction; of one that slides u is its part along a.
struct Sums {
  Vector both, own, all;
  explicit Sums(std::size_t wheels = 0);
  Sums& operator+=(const Sums& other);
};
struct Drive {
  const Recording* recording = nullptr;
  Vector t;         // s, from 0
  double step = 0;  // T, the median, s
  bool increments = false;
  Matrix motion;          // rad, one row per interval, a column per drive signal
  Matrix angle;           // rad, one row per stamp, a column per steering signal
  bool dense = false;     // a reference at every stamp; all below needs it
  Vector x, y, theta;     // m, m, rad
  std::vector<char> bad;  // samples not to be looked at
  bool holes = false;     // a gap is left in the stamps

  LocalLine line;
  Vector fx, fy, w;  // twist of the reference in the body frame: F
  Matrix speed;      // s_i, rad/s: one column per wheel
  Matrix c, s;       // a / |a| of each wheel
  Matrix twist;      // Wt: vx, vy, omega; one row per stamp
  Vector mean_u;     // mean |u_i|
  double level = 0;  // its 95th percentile
  std::vector<char> used;
  Sums sums;  // of the used samples

  Index samples() const { return t.size(); }
  const std::string& id() const { return recording->id; }
  double seconds(Index interval) const { return t[interval + 1] - t[interval]; }
};

// Stamps, signals and reference of a recording. Throws std::invalid_argument for a signal that it lacks.
Drive drive_view(const RobotView& robot, const Recording& recording);
// After a change of the stamps: T, h = max(2, round(0.25 s / T)), at most max(3, n div 20).
void update_stamps(Drive& drive);
// F = (cos th X' + sin th Y', -sin th X' + cos th Y', th'), derivatives by D.
void update_reference(Drive& drive);
// s_i = D[sum of motions], and where the wheels point to.
void update_wheels(const RobotView& robot, Drive& drive);
// The least-squares twist of the wheels, summed up and through D.
void update_twist(const RobotView& robot, Drive& drive);
// Path of the mean wheel in an interval, m.
double wheel_path(const RobotView& robot, const Drive& drive, Index interval);

// u_i = (F_x - w p_y, F_y + w p_x), the velocity of wheel i by the reference, all samples.
struct WheelVelocity {
  Vector x, y;
  Vector along;  // (a / |a|).u
};
WheelVelocity velocity_of(const RobotView& robot, const Drive& drive, std::size_t wheel);
// m_i along a / |a|: r s_i / |a|.
Vector rolling_of(const RobotView& robot, const Drive& drive, std::size_t wheel);

// mean_u, level, sums, used: mean |u_i| > 0.3 of its 95th percentile, without h samples at the ends and bad
// ones.
void update_sums(const RobotView& robot, Drive& drive);

// k_i = sum u.m / sum m.m; E = sum_i sum |u - k m|^2 / sum_i sum |u|^2; score = E + 0.05 sd|k_i| / mean|k_i|
// + 0.02 (number of k_i < 0). k_i is not-a-number where a wheel never turns or only steers.
struct SlopeFit {
  Vector slope;
  double misfit = 0, score = 0;
};
SlopeFit slope_fit(const RobotView& robot, const Sums& sums);
// E of one recording with the slopes of the set.
double misfit_with(const Sums& sums, const Vector& slope);

}  // namespace odobench::inspection
